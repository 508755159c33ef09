// apps: pushid-simulate --formation: an identified model on people who stand together.
#pragma once

namespace pushid {

// Returns the exit code.
int SimulateFormation();

}  // namespace pushid
