// apps: the command line of every program: help, version, common checks.
#pragma once

#include <string>
#include <vector>

#include "apps/flags/flag_table.h"
#include "apps/support/app_support.h"
#include "apps/support/overwrite_check.h"

namespace pushid {

// Alone on a command line: prints FlagList and nothing else.
inline constexpr char kListFlags[] = "--list_flags";
// The same for the program's page of the manual.
inline constexpr char kManPage[] = "--man_page";

// Parses flags (--help and --version answer themselves), refuses outputs that would replace an
// input or each other, then calls run. usage: one paragraph and an example. Words that are no flags
// go to `words`; without it they are an error. moved: flags that work here for one more version.
int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words = nullptr, const MovedFlags& moved = {});

// A flag that is given several times would keep its last value alone: all of them, with the
// separator between. Before RunApp.
void JoinRepeated(const std::string& flag, char separator, int argc, char** argv);

// A program's page of the manual (man_page.cc), from its usage and its table of flags, as man(7)
// has it. usage: "pushid-name does this. More of it.\n\n  pushid-name --example=1": the first
// sentence is the page's line in whatis, indented lines are examples. heading: OPTIONS, and the
// words that a command line takes, [--flag=value] ...
std::string ManPage(const std::string& usage, const std::string& words, const std::string& heading,
                    const std::vector<HelpSection>& sections);

}  // namespace pushid
