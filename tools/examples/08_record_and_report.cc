// SPDX-License-Identifier: BSD-3-Clause
// Records a run for Foxglove and makes a report for a browser:
//     08_record_and_report [FILE [RECORD [REPORT]]]
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "oca/diagrams/record/record_sink.h"
#include "oca/diagrams/record/run_recorder.h"
#include "oca/tools/simulator/report_writer.h"
#include "oca/version.h"

int main(int argc, char** argv) {
  const std::string file = argc > 1 ? argv[1] : "diagrams/first.yaml";
  const std::string record = argc > 2 ? argv[2] : "first.mcap";
  const std::string report = argc > 3 ? argv[3] : "first.html";
  try {
    const auto loaded = oca::loading::LoadDiagram(file);
    std::ofstream stream(record, std::ios::binary);
    oca::record::McapSink sink(stream, oca::record::Compression::kZstd);
    oca::record::RunRecorder recorder(loaded, {.version = oca::Version()}, {&sink}, nullptr);
    oca::tools::ReportWriter page(report, loaded, {}, nullptr);

    // Both look on; neither changes the run.
    const auto result = oca::runs::Run(loaded, {.observers = {&recorder, &page.recorder()}});
    stream.close();
    page.Finish();

    std::printf("OCA %s: %s, %s\n", oca::Version(), loaded.name.c_str(),
                result.ExpectationsMet() ? "as expected" : "not as expected");
    for (const std::string& made : {record, report}) {
      std::printf("%s: %s\n", made.c_str(),
                  std::filesystem::file_size(made) > 10000 ? "written" : "too short");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
