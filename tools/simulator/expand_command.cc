// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/runs/output_files.h"
#include "oca/models/opened_files.h"
#include "oca/models/robot/xacro.h"
#include "oca/models/whole_file.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"
#include "tools/simulator/xacro_arguments.h"

namespace oca::tools {

int ExpandCommand(const ExpandArguments& arguments) {
  robot::XacroOptions options;
  options.arguments = ParseXacroArguments(arguments.arguments);
  const std::filesystem::path xacro = files::ResolvePath(arguments.xacro, {}, {});
  options.find_package = [&xacro](const std::string& package) {
    return files::PackageFor(xacro, package);
  };
  options.package_directories = files::PackageFolders();
  options.package_advice = files::kPackageAdvice;
  options.warn = [](const std::string& line) { Tell("warning: {}\n", line); };
  models::OpenedFiles opened;
  const robot::ExpandedXacro expanded = robot::ExpandXacro(xacro, options);
  if (arguments.output.empty()) {
    WriteData(expanded.urdf);
    return kFine;
  }
  runs::CheckOutputs({{"--output", arguments.output}},
                     runs::InputsOf(opened.files(), "what is expanded"));
  models::WriteWhole(arguments.output, expanded.urdf);
  Tell("wrote {}\n", arguments.output);
  return kFine;
}

}  // namespace oca::tools
