// SPDX-License-Identifier: BSD-3-Clause
// One reader under libFuzzer: the one that the variable OCA_FUZZ_READER names.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/readers.h"

namespace {

const oca::test::Reader& Chosen() {
  const char* const name = std::getenv("OCA_FUZZ_READER");
  for (const oca::test::Reader& reader : oca::test::Readers()) {
    if (name != nullptr && std::string_view(name) == reader.name) return reader;
  }
  std::fprintf(stderr, "OCA_FUZZ_READER: got %s; expected one of", name ? name : "nothing");
  for (const oca::test::Reader& reader : oca::test::Readers()) {
    std::fprintf(stderr, " %s", reader.name);
  }
  std::fputs("\n", stderr);
  std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const oca::test::Reader& reader = Chosen();
  reader.read(std::string_view(reinterpret_cast<const char*>(data), size));
  return 0;
}
