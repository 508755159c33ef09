// ident: the one table of parameters in a fit: what is known of each (models/parameters.h) and
// what the fit does with it: start, free or fixed, pooled, prior. Flags edit it; the solver, the
// report and the result JSON read it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/figures/text_table.h"
#include "models/force_law.h"
#include "residuals/parameter_map.h"

namespace pushid {

struct Prior {
  double mean;   // in the parameter's unit
  double sigma;  // in the parameter's unit; on a log scale it becomes sigma / mean
};

// Where the estimate of the units' spread starts; 0.3 is about 30 % for a positive parameter.
inline constexpr double kFirstPoolingSigma = 0.3;

struct ParameterSpec {
  Parameter id{};
  std::string name;
  std::string unit;
  double nominal = 0.0;  // start of a fit, value when fixed
  double lower = 0.0, upper = 0.0;
  double scale = 1.0;  // a typical size, for scaling null directions and judging "weak"
  Transform transform = Transform::kIdentity;
  bool free = false;
  bool pooled = false;  // may deviate by subject, setting or condition
  // Standard deviation of a unit's deviation where it is pooled, as PoolingSigma has it.
  double pooling_sigma = kFirstPoolingSigma;
  std::optional<Prior> prior;
  // The parameter whose value it takes; none where a flag names the parameter itself.
  std::optional<Parameter> tied_to;
  // The parameter that a slope moves, and by what (residuals/parameter_map.h).
  struct SlopeOf {
    Parameter target;
    Covariate covariate;
  };
  std::optional<SlopeOf> slope_of;
  bool named = false;   // by a flag
  std::string meaning;  // one line for people
};

// The law of self forces that is fitted beyond balance, friction and the preset's own
// (models/self_terms.h). Its parameters are zero where it does not act, and are freed where it
// does.
enum class SelfForceKind { kNone, kLinear };
constexpr EnumNames<SelfForceKind, 2> Names(SelfForceKind) {
  return {{{"none", SelfForceKind::kNone}, {"linear", SelfForceKind::kLinear}}};
}
inline constexpr int kFirstLinear = kAx, kLastLinear = kDq;

struct ParameterTable {
  std::vector<ParameterSpec> specs;  // indexed by Parameter, a user's own at the end

  // A row for the next parameter, fixed.
  ParameterSpec& Add(const ParameterFacts& facts);
  ParameterSpec& operator[](Parameter id) { return specs[id]; }
  const ParameterSpec& operator[](Parameter id) const { return specs[id]; }
  // nullptr when there is none of that name.
  ParameterSpec* Find(const std::string& name);
  const ParameterSpec* Find(const std::string& name) const;
  std::vector<Parameter> Free() const;
  ParameterSet<double> Values() const;  // nominal values
  ParameterMap Map() const;  // fitted = free, in table order; with the covariates of all slopes
  void SetTied(ParameterSet<double>* values) const;  // to the values of what they are tied to
};

// Every parameter there is, fixed at a value that makes its term vanish, or at LDP's value.
ParameterTable BaseTable();

// Standard deviation of a unit's deviation on the fitted scale: on a log scale pooling_sigma
// itself, on an identity scale that many typical sizes of the parameter.
double PoolingSigma(const ParameterSpec& spec);

// Whether some parameter may differ by unit.
bool AnyPooled(const ParameterTable& table);

// The flags --fix, --free, --prior, --set and --pool: comma-separated
//   fix:   name or name=value      free: name or name=start value
//   prior: name:mean:sigma         set:  name=value (also of a fixed one)
//   pool:  names, or all, or none; -name leaves out, as in all,-mu
struct TableEdits {
  std::string fix, free, prior, set, pool;
  std::string pool_by = kSubjectUnit;
};
MaybeError EditTable(const TableEdits& edits, ParameterTable* table);

// Names that act only between people who touch must not be given where nobody does.
MaybeError CheckTouching(const std::string& assignments, const std::string& flag,
                         const ParameterTable& table, const ModelOptions& model);

// Whether what a pool lists holds for any table: no name in it need be free.
bool PoolsAllOrNone(const std::string& pool);

// name=value pairs, for --set in what-ifs.
struct NamedValue {
  std::string name;
  double value;
};
Result<std::vector<NamedValue>> ParseAssignments(const std::string& text, const std::string& flag);

// The covariates of one parameter.
struct CovariatesOfParameter {
  std::string parameter;
  std::vector<std::string> keys;
};

// "Kp_theta ~ age + height; Kd_theta ~ age". Errors: a part without '~' or without a name on
// either side, the same covariate of a parameter twice.
Result<std::vector<CovariatesOfParameter>> ParseCovariates(const std::string& text);

// Every parameter in words, from its row (models/parameters.h), as a table in Markdown: name,
// symbol (in the equation that heads the file of its term), unit, value where no preset sets one,
// bounds, meaning, and when to free it.
std::string ParameterGlossary();

// A user's own force laws in a fit.

using ForceLaws = std::vector<std::shared_ptr<const ForceLaw>>;

// Gives a law to the model and its parameters to the table: free, starting at their nominal values,
// without priors. Errors: a second law of that name, a parameter whose name is taken, more of them
// than there are slots. Nothing is added then.
MaybeError AddForceLaw(std::shared_ptr<const ForceLaw> law, ModelOptions* model,
                       ParameterTable* table);

// Adds the laws that a model file names, in its order. Errors: one that is not among `laws`.
MaybeError AddNamedLaws(const std::vector<std::string>& names, const ForceLaws& laws,
                        ModelOptions* model, ParameterTable* table);

// Names of the laws, in the model's order.
std::vector<std::string> LawNames(const ModelOptions& model);

}  // namespace pushid
