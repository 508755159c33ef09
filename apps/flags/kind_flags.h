// apps: flags of one kind of generator alone. Each kind has them in a file of its own, where they
// register themselves as flags do:
//
//   const KindFlags<GenerateFlags> kFlagsOfKind(GeneratorKind::kWaves, {"wave_height"}, Read);
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "ident/generators/generator_files.h"

namespace pushid {

// Flags: what the program's own flags are read into.
template <typename Flags>
class KindFlags {
 public:
  // read: checks them, and puts what they say into its argument; also what the kind makes of flags
  // that several kinds have.
  KindFlags(GeneratorKind kind, std::vector<const char*> names, void (*read)(Flags* flags))
      : kind_(kind), names_(std::move(names)), read_(read) {
    All().push_back(this);
  }

  static void ReadAll(Flags* flags) {
    for (const KindFlags* of_kind : All()) of_kind->read_(flags);
  }

  // The flags of other kinds, which do not apply to this one, each with its kind.
  struct Foreign {
    const char* flag;
    GeneratorKind of;
  };
  static std::vector<Foreign> ForeignTo(GeneratorKind kind) {
    std::vector<Foreign> foreign;
    for (const KindFlags* other : All()) {
      if (other->kind_ == kind) continue;
      for (const char* flag : other->names_) foreign.push_back({flag, other->kind_});
    }
    return foreign;
  }

 private:
  static std::vector<const KindFlags*>& All() {
    static std::vector<const KindFlags*> all;
    return all;
  }

  GeneratorKind kind_;
  std::vector<const char*> names_;
  void (*read_)(Flags* flags);
};

// --published: the settings of a paper, as other defaults of a program's own flags.

struct PublishedFlags {
  const char* paper;  // its name on the command line
  std::vector<std::pair<const char*, const char*>> values;
};

// Makes the values of the paper that --published names the defaults, before any flag is read: flags
// that are given win. Errors: no such paper.
void TakePublished(const std::vector<PublishedFlags>& papers);

}  // namespace pushid
