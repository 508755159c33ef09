// apps: completion scripts.
#include "apps/completion.h"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/support/processes.h"

namespace pushid {
namespace {

struct CompletedFlag {
  std::string name;
  bool is_bool = false;
  std::string words;  // with spaces between; empty: a file's name, or any
  std::string help;
};

struct CompletedProgram {
  Command command;
  std::vector<CompletedFlag> flags;
};

// What a program prints for kListFlags (flag_table.h).
std::vector<CompletedFlag> FlagsOf(const std::string& list) {
  std::vector<CompletedFlag> flags;
  std::istringstream lines(list);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    CompletedFlag flag;
    std::string kind;
    std::getline(cells, flag.name, '\t');
    std::getline(cells, kind, '\t');
    std::getline(cells, flag.words, '\t');
    std::getline(cells, flag.help, '\t');
    flag.is_bool = kind == "bool";
    flags.push_back(flag);
  }
  for (const char* name : {"help", "version"}) flags.push_back({name, true, "", ""});
  return flags;
}

// Inside single quotes, with a backslash before each of `special`.
std::string Escaped(const std::string& help, const std::string& special, const char* quote) {
  std::string text;
  for (const char c : help) {
    if (special.find(c) != std::string::npos) text += '\\';
    text += c == '\'' ? std::string(quote) : std::string(1, c);
  }
  return text;
}

// A colon or a bracket ends a part of a zsh description.
std::string ZshText(const std::string& help) { return Escaped(help, "\\:[]", "'\\''"); }
std::string FishText(const std::string& help) { return Escaped(help, "\\", "\\'"); }

std::string Names(const std::vector<CompletedProgram>& programs, const std::string& before) {
  std::string text;
  for (const CompletedProgram& program : programs) {
    text += (text.empty() ? "" : " ") + before + program.command.name;
  }
  return text;
}

constexpr char kBashEnd[] = R"bash(
_pushid() {
  local program=${COMP_WORDS[0]##*/} cur=${COMP_WORDS[COMP_CWORD]} flag= words
  COMPREPLY=()
  if [[ $program == pushid ]]; then
    if ((COMP_CWORD == 1)); then
      COMPREPLY=($(compgen -W "$_pushid_commands help completion" -- "$cur"))
      return
    elif [[ ${COMP_WORDS[1]} == help ]]; then
      COMPREPLY=($(compgen -W "$_pushid_commands" -- "$cur"))
      return
    elif [[ ${COMP_WORDS[1]} == completion ]]; then
      COMPREPLY=($(compgen -W "bash zsh fish" -- "$cur"))
      return
    fi
    program=pushid-${COMP_WORDS[1]}
  fi
  if [[ $cur == "=" ]]; then
    flag=${COMP_WORDS[COMP_CWORD - 1]} cur=
  elif [[ ${COMP_WORDS[COMP_CWORD - 1]} == "=" ]]; then
    flag=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  if [[ -n $flag ]]; then
    words=$(_pushid_words "$program" "$flag")
    if [[ -n $words ]]; then
      COMPREPLY=($(compgen -W "$words" -- "$cur"))
    else
      compopt -o filenames
      COMPREPLY=($(compgen -f -- "$cur"))
    fi
    return
  fi
  COMPREPLY=($(compgen -W "$(_pushid_flags "$program")" -- "$cur"))
  [[ ${COMPREPLY[0]} != *= ]] || compopt -o nospace
}
)bash";

std::string BashScript(const std::vector<CompletedProgram>& programs) {
  std::string flags, words;
  for (const CompletedProgram& program : programs) {
    const std::string name = "pushid-" + program.command.name;
    std::string all;
    for (const CompletedFlag& flag : program.flags) {
      all += (all.empty() ? "--" : " --") + flag.name + (flag.is_bool ? "" : "=");
      if (flag.words.empty()) continue;
      words += "    '" + name + " --" + flag.name + "') echo '" + flag.words + "' ;;\n";
    }
    flags += "    " + name + ") echo '" + all + "' ;;\n";
  }
  return "_pushid_commands='" + Names(programs, "") + "'\n_pushid_flags() {\n  case $1 in\n" +
         flags + "  esac\n}\n_pushid_words() {\n  case \"$1 $2\" in\n" + words + "  esac\n}" +
         kBashEnd + "complete -F _pushid pushid " + Names(programs, "pushid-") + "\n";
}

std::string ZshScript(const std::vector<CompletedProgram>& programs) {
  std::string described, cases;
  for (const CompletedProgram& program : programs) {
    described += "      '" + program.command.name + ":" + ZshText(program.command.line) + "'\n";
    cases += "    pushid-" + program.command.name + ") _arguments";
    for (const CompletedFlag& flag : program.flags) {
      cases +=
          " \\\n      '--" + flag.name + (flag.is_bool ? "" : "=") + "[" + ZshText(flag.help) + "]";
      if (!flag.is_bool) cases += flag.words.empty() ? ":value:_files" : ": :(" + flag.words + ")";
      cases += "'";
    }
    cases += " ;;\n";
  }
  return "#compdef pushid " + Names(programs, "pushid-") +
         "\n_pushid() {\n"
         "  local program=$service commands\n"
         "  if [[ $program == pushid ]]; then\n"
         "    commands=(\n" +
         described +
         "      'help:list the commands, or the flags of one'\n"
         "      'completion:a script for a shell'\n"
         "    )\n"
         "    if ((CURRENT == 2)); then _describe command commands; return; fi\n"
         "    if [[ $words[2] == help ]]; then _describe command commands; return; fi\n"
         "    if [[ $words[2] == completion ]]; then compadd bash zsh fish; return; fi\n"
         "    program=pushid-$words[2]\n"
         "    shift words\n"
         "    ((CURRENT--))\n"
         "  fi\n"
         "  case $program in\n" +
         cases + "  esac\n}\ncompdef _pushid pushid " + Names(programs, "pushid-") + "\n";
}

std::string FishScript(const std::vector<CompletedProgram>& programs) {
  std::string text =
      "complete -c pushid -f\n"
      "complete -c pushid -n __fish_use_subcommand -a help -d 'list the commands'\n"
      "complete -c pushid -n __fish_use_subcommand -a completion -d 'a script for a shell'\n"
      "complete -c pushid -n '__fish_seen_subcommand_from completion' -a 'bash zsh fish'\n"
      "complete -c pushid -n '__fish_seen_subcommand_from help' -a '" +
      Names(programs, "") + "'\n";
  for (const CompletedProgram& program : programs) {
    const std::string& name = program.command.name;
    text += "complete -c pushid -n __fish_use_subcommand -a " + name + " -d '" +
            FishText(program.command.line) + "'\n";
    for (const CompletedFlag& flag : program.flags) {
      const std::string takes = flag.is_bool         ? ""
                                : flag.words.empty() ? " -r -F"
                                                     : " -x -a '" + flag.words + "'";
      const std::string rest = " -l " + flag.name + takes + " -d '" + FishText(flag.help) + "'\n";
      text += "complete -c pushid-" + name + rest;
      text += "complete -c pushid -n '__fish_seen_subcommand_from " + name + "'" + rest;
    }
  }
  return text;
}

struct Shell {
  const char* name;
  const char* install;
  std::string (*script)(const std::vector<CompletedProgram>& programs);
};
constexpr Shell kShells[] = {
    {"bash", "in ~/.bashrc: source <(pushid completion bash)", BashScript},
    {"zsh", "in ~/.zshrc, after compinit: source <(pushid completion zsh)", ZshScript},
    {"fish", "pushid completion fish >~/.config/fish/completions/pushid.fish", FishScript}};

}  // namespace

std::string CompletionHelp() {
  std::string text =
      "pushid completion SHELL prints a script that completes commands and flags.\n\n";
  for (const Shell& shell : kShells) {
    text += std::string("  ") + shell.name + ": " + shell.install + "\n";
  }
  return text;
}

Result<std::string> CompletionScript(const std::string& shell,
                                     const std::vector<Command>& commands) {
  const auto chosen = std::find_if(std::begin(kShells), std::end(kShells),
                                   [&](const Shell& one) { return shell == one.name; });
  if (chosen == std::end(kShells)) {
    return Error{"there is completion for bash, zsh and fish, not for '" + shell + "'"};
  }
  std::vector<CompletedProgram> programs;
  for (const Command& command : commands) {
    const std::string file = FindProgram("pushid-" + command.name);
    if (file.empty()) continue;
    const Result<std::string> list = OutputOf({file, kListFlags});
    if (!list.ok()) return list.error();
    programs.push_back({command, FlagsOf(list.value())});
  }
  // zsh looks for #compdef in the first line of a file.
  return chosen->script(programs) + "# Completion of pushid: " + chosen->install + "\n";
}

}  // namespace pushid
