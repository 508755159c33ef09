// ident: a report as one HTML page that needs nothing else: no network, no other file. Sections
// without anything in them are left out.
#pragma once

#include <string>

#include "ident/report/page/document.h"

namespace pushid {

std::string ToPage(const Report& report);

}  // namespace pushid
