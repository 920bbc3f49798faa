// SPDX-License-Identifier: BSD-3-Clause
// Records a run for Foxglove and makes a report for a browser:
//     08_record_and_report [FILE [RECORD [REPORT]]]
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "oca/diagrams/record/record.h"
#include "oca/diagrams/record/report.h"
#include "oca/diagrams/runs/run.h"
#include "oca/version.h"

int main(int argc, char** argv) {
  const std::string file = argc > 1 ? argv[1] : "diagrams/first.yaml";
  const std::string record_file = argc > 2 ? argv[2] : "first.mcap";
  const std::string report_file = argc > 3 ? argv[3] : "first.html";
  try {
    const auto loaded = oca::loading::LoadDiagram(file);
    oca::record::Record record(record_file);
    oca::record::Report report(report_file);

    // Both look on; neither changes the run.
    const auto result = oca::runs::Run(loaded, {.outputs = {&record, &report}});
    if (result.failure) std::fprintf(stderr, "%s\n", result.failure->message.c_str());

    std::printf("OCA %s: %s, %s\n", oca::Version(), loaded.name.c_str(),
                result.ExpectationsMet() ? "as expected" : "not as expected");
    for (const std::string& made : {record_file, report_file}) {
      std::printf("%s: %s\n", made.c_str(),
                  std::filesystem::file_size(made) > 10000 ? "written" : "too short");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
