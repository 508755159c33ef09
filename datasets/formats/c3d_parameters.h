// datasets: the parameter section of a C3D file, read and looked up; what it says of events and
// force platforms.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/c3d.h"
#include "datasets/formats/c3d_bytes.h"

namespace pushid {

// "at byte 1234: ..." of the file at `path`.
Error C3dError(const std::string& path, std::size_t at, const std::string& message);

// Reads the records from byte `begin` (behind the section's four head bytes). Errors: a record that
// leaves the section, a parameter of a group that never appears, an unknown type.
Result<std::vector<C3dParameter>> ReadC3dParameters(const std::string& path, const C3dBytes& bytes,
                                                    std::size_t begin);

// The parameter GROUP:NAME whatever its case, or null.
const C3dParameter* FindC3dParameter(const std::vector<C3dParameter>& parameters,
                                     std::string_view group, std::string_view name);

// Its number at `index`, or `fallback`.
double C3dNumber(const std::vector<C3dParameter>& parameters, std::string_view group,
                 std::string_view name, std::size_t index, double fallback);

// C3dNumber as a whole number from `lowest` to `highest`; `fallback` for anything else.
int C3dWhole(const std::vector<C3dParameter>& parameters, std::string_view group,
             std::string_view name, std::size_t index, int lowest, int highest, int fallback);

// Its numbers, or its texts, and those of NAME2, NAME3, ... which files use beyond 255 entries.
std::vector<double> C3dNumbers(const std::vector<C3dParameter>& parameters, std::string_view group,
                               const std::string& name);
std::vector<std::string> C3dTexts(const std::vector<C3dParameter>& parameters,
                                  std::string_view group, const std::string& name);

// The events of the group EVENT, otherwise those of the header at the start of `bytes`.
std::vector<C3dEvent> ReadC3dEvents(const std::vector<C3dParameter>& parameters,
                                    const C3dBytes& bytes);

// Fills file->platforms from its parameters; its analog channels are there already. Errors: an
// unknown type, too few channels, a channel that does not exist.
MaybeError ReadC3dPlatforms(C3dFile* file);

}  // namespace pushid
