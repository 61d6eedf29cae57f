// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam completion bash: a script made from the options that the verbs declare.
#include <fmt/core.h>
#include <gloam/renderer.h>

#include "arguments.h"
#include "verb.h"

namespace gloam::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  return CLI::detail::join(words, " ");
}

std::vector<std::string> namesOf(const char* prefix, const std::vector<BuiltinScene>& entries) {
  std::vector<std::string> names;
  for (const BuiltinScene& entry : entries) names.push_back(std::string(prefix) + entry.name);
  return names;
}

/// What completes a value of this kind: words, and "-f" for files, "-d" for folders.
struct Values {
  std::vector<std::string> words;
  bool files = false, folders = false;
};

Values valuesOf(const std::string& kind) {
  Values values;
  for (const std::string& part : CLI::detail::split(kind, '|')) {
    if (part == "FILE" || part == "SCENE" || part == "LIGHT") values.files = true;
    if (part == "FOLDER") values.folders = true;
    if (part == "SCENE") values.words = namesOf("builtin:", builtinScenes());
    if (part == "LIGHT") values.words = namesOf("sky:", builtinSkies());
    if (part == "TECHNIQUE" || part == "SUBJECT") {
      for (const TechniqueInfo& info : techniques()) values.words.emplace_back(info.name);
    }
    if (!part.empty() && std::islower(static_cast<unsigned char>(part.front()))) values.words.push_back(part);
  }
  return values;
}

std::string action(const Values& values) {
  std::string text = fmt::format("_gloam_words '{}'", joined(values.words));
  if (values.files) text += "; _gloam_files";
  if (values.folders && !values.files) text += "; _gloam_folders";
  return text;
}

/// A case of the script: what follows `previous`, and which options there are.
std::string verbCase(const CLI::App& app, const std::string& name) {
  std::string values;
  std::vector<std::string> flags;
  Values positional;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      const Values more = valuesOf(option->get_type_name());
      positional.words.insert(positional.words.end(), more.words.begin(), more.words.end());
      positional.files |= more.files;
      continue;
    }
    std::vector<std::string> names;
    for (const std::string& flag : option->get_lnames()) names.push_back("--" + flag);
    flags.insert(flags.end(), names.begin(), names.end());
    for (const std::string& flag : option->get_snames()) names.push_back("-" + flag);
    if (option->get_type_size() != 0) {
      values += fmt::format("        {}) {}; return ;;\n", CLI::detail::join(names, "|"),
                            action(valuesOf(option->get_type_name())));
    }
  }
  return fmt::format(
      "    {})\n      case $previous in\n{}      esac\n      case $word in\n        -*) "
      "_gloam_words '{}' ;;\n        "
      "*) {} ;;\n      esac ;;\n",
      name, values, joined(flags), action(positional));
}

/// How the script calls a verb: "bake_spheres".
std::string caseOf(std::string name) {
  std::ranges::replace(name, ' ', '_');
  return name;
}

std::string bashScript() {
  std::vector<std::string> names = {"--help", "--version"};
  std::string cases, two_words;
  for (const Verb* verb : verbs()) {
    const std::string name = verb->name;
    const std::size_t space = name.find(' ');
    if (space == std::string::npos) {
      names.push_back(name);
    } else {  // "bake spheres": its second word completes where the first one's argument does
      const std::string second = name.substr(space + 1);
      two_words += fmt::format(
          "  if [[ $verb == {} ]]; then\n"
          "    if [[ ${{COMP_WORDS[2]-}} == {} && ${{#typed[@]}} -gt 3 ]]; then verb={}; "
          "elif [ ${{#typed[@]}} -eq 3 ]; then _gloam_words {}; fi\n  fi\n",
          name.substr(0, space), second, caseOf(name), second);
    }
    Console unused;
    cases += verbCase(*declareVerb(*verb, unused).app, caseOf(name));
  }
  // Bash breaks words at colons: what stands before the last one is taken off the answers again.
  return "# bash completion for gloam, made by `gloam completion bash`\n"
         "_gloam_words() { COMPREPLY+=($(compgen -W \"$1\" -- \"$word\")); }\n"
         "_gloam_files() { local IFS=$'\\n'; compopt -o filenames; COMPREPLY+=($(compgen -f -- \"$word\")); "
         "}\n"
         "_gloam_folders() { local IFS=$'\\n'; compopt -o filenames; COMPREPLY+=($(compgen -d -- "
         "\"$word\")); }\n"
         "_gloam() {\n"
         "  local line=\"${COMP_LINE:0:COMP_POINT}\" word previous verb=${COMP_WORDS[1]-}\n"
         "  local -a typed; read -ra typed <<< \"$line\"\n"
         "  case $line in *[[:space:]]) typed+=('') ;; esac\n"
         "  word=${typed[-1]} previous=${typed[-2]}\n"
         "  COMPREPLY=()\n"
         "  if [ ${#typed[@]} -le 2 ]; then _gloam_words '" +
         joined(names) + "'; return; fi\n" + two_words +
         "  _gloam_verb\n"
         "  if [[ $word == *:* && $COMP_WORDBREAKS == *:* ]]; then\n"
         "    local cut=\"${word%\"${word##*:}\"}\" i\n"
         "    for i in \"${!COMPREPLY[@]}\"; do COMPREPLY[i]=${COMPREPLY[i]#\"$cut\"}; done\n"
         "  fi\n"
         "}\n"
         "_gloam_verb() {\n"
         "  case $verb in\n" +
         cases +
         "  esac\n"
         "}\n"
         "complete -F _gloam gloam";
}

std::function<int()> declareCompletion(CLI::App& app, Console& console) {
  const auto shell = std::make_shared<std::string>();
  addChoice(app, "SHELL", *shell, {"bash"}, "bash")->required();
  return [shell, &console] {
    console.print(bashScript());
    return kDone;
  };
}

}  // namespace

extern const Verb kCompletionVerb;
const Verb kCompletionVerb = {
    "completion", "prints a completion script for the shell",
    "eval \"$(gloam completion bash)\" | in this shell\n"
    "gloam completion bash > ~/.local/share/bash-completion/completions/gloam | for good\n",
    declareCompletion};

}  // namespace gloam::cli
