// SPDX-License-Identifier: BSD-3-Clause
// verification_page FOLDER: writes README.md and work_precision.svg into the folder.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/verification/page.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: verification_page FOLDER\n");
    return 64;
  }
  const std::filesystem::path folder = argv[1];
  std::ofstream page(folder / "README.md"), figure(folder / "work_precision.svg");
  page << oca::verification::MakePage();
  figure << oca::verification::MakeFigure();
  page.close();
  figure.close();
  if (page && figure) return 0;
  std::fprintf(stderr, "%s: cannot be written\n", argv[1]);
  return 1;
}
