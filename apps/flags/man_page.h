// apps: a program's page of the manual, from its usage and its table of flags.
#pragma once

#include <string>
#include <vector>

#include "apps/flags/flag_table.h"

namespace pushid {

// As man(7) has it. usage: "pushid-name does this. More of it.\n\n  pushid-name --example=1": the
// first sentence is the page's line in whatis, indented lines are examples. heading: OPTIONS, and
// the words that a command line takes, [--flag=value] ...
std::string ManPage(const std::string& usage, const std::string& words, const std::string& heading,
                    const std::vector<HelpSection>& sections);

}  // namespace pushid
