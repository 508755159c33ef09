// apps: the command line of every program: help, version, common checks.
#pragma once

#include <string>
#include <vector>

#include "apps/flags/flag_table.h"
#include "apps/support/app_support.h"
#include "apps/support/overwrite_check.h"

namespace pushid {

// Parses flags (--help and --version answer themselves), refuses outputs that would replace an
// input or each other, then calls run. usage: one paragraph and an example. Words that are no flags
// go to `words`; without it they are an error.
int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words = nullptr);

// A flag that is given several times would keep its last value alone: all of them, with the
// separator between. Before RunApp.
void JoinRepeated(const std::string& flag, char separator, int argc, char** argv);

}  // namespace pushid
