// SPDX-License-Identifier: BSD-3-Clause
// One reader under libFuzzer: the one that the variable OCA_FUZZ_READER names; `list` prints all,
// each with the number of inputs after which little new is to be expected.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/readers.h"

namespace {

using oca::test::Reader;

void PrintReaders(std::FILE* to) {
  for (const Reader& reader : oca::test::Readers()) {
    std::fprintf(to, "%s %d\n", reader.name,
                 reader.kind == Reader::Kind::kBinary ? 1'000'000 : 100'000);
  }
}

const Reader& Chosen() {
  const char* const named = std::getenv("OCA_FUZZ_READER");
  const std::string_view name = named == nullptr ? "" : named;
  if (name == "list") {
    PrintReaders(stdout);
    std::exit(0);
  }
  for (const Reader& reader : oca::test::Readers()) {
    if (name == reader.name) return reader;
  }
  std::fputs("OCA_FUZZ_READER: expected the name of a reader:\n", stderr);
  PrintReaders(stderr);
  std::exit(2);
}

const Reader* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*count*/, char*** /*words*/) {
  chosen = &Chosen();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->read(std::string_view(reinterpret_cast<const char*>(data), size));
  return 0;
}
