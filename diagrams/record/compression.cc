// SPDX-License-Identifier: BSD-3-Clause
// Compression of chunks, of mcap.h and mcap_bytes.h.
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <array>
#include <memory>

#include "oca/diagrams/record/mcap_bytes.h"
#include "oca/framework/dataflow/error.h"

namespace oca::record {
namespace {

constexpr std::array kUserNames{"none", "lz4", "zstd"};
constexpr std::array<std::string_view, 3> kMcapNames{"", "lz4", "zstd"};

/// Largest chunk that is unpacked, bytes: a damaged length must not exhaust the memory.
constexpr std::size_t kLargestChunk = std::size_t{1} << 30;

std::string DecompressZstd(std::string_view bytes, std::size_t size) {
  std::string out(size, '\0');
  const std::size_t got = ZSTD_decompress(out.data(), size, bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0 || got != size) throw ConfigError("chunk: no zstd frame of its size");
  return out;
}

std::string DecompressLz4(std::string_view bytes, std::size_t size) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(
      context, &LZ4F_freeDecompressionContext);
  std::string out(size, '\0');
  std::size_t read = 0, written = 0, hint = 1;
  while (hint != 0) {
    std::size_t from = bytes.size() - read, to = size - written;
    hint = LZ4F_decompress(context, out.data() + written, &to, bytes.data() + read, &from, nullptr);
    read += from;
    written += to;
    if (LZ4F_isError(hint) != 0 || (hint != 0 && from == 0 && to == 0)) break;
  }
  if (hint != 0 || written != size) throw ConfigError("chunk: no lz4 frame of its size");
  return out;
}

/// As ZSTD_compress, with memory that stays from one chunk to the next.
std::size_t CompressZstd(std::string_view bytes, char* out, std::size_t bound, int level) {
  thread_local const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                                  &ZSTD_freeCCtx);
  if (context == nullptr) throw std::bad_alloc();
  return ZSTD_compressCCtx(context.get(), out, bound, bytes.data(), bytes.size(), level);
}

}  // namespace

Compression ParseCompression(const std::string& name) {
  for (std::size_t i = 0; i < kUserNames.size(); ++i) {
    if (name == kUserNames[i]) return static_cast<Compression>(i);
  }
  throw ConfigError(fmt::format("record compression: got '{}'; expected none, lz4 or zstd", name));
}

std::string_view CompressionName(Compression compression) {
  return kMcapNames[static_cast<std::size_t>(compression)];
}

void Compress(Compression compression, int level, std::string_view bytes, std::string& out) {
  if (compression == Compression::kNone) {
    out += bytes;
    return;
  }
  const bool zstd = compression == Compression::kZstd;
  const std::size_t start = out.size();
  const std::size_t bound =
      zstd ? ZSTD_compressBound(bytes.size()) : LZ4F_compressFrameBound(bytes.size(), nullptr);
  out.resize(start + bound);
  const std::size_t size =
      zstd ? CompressZstd(bytes, out.data() + start, bound, level)
           : LZ4F_compressFrame(out.data() + start, bound, bytes.data(), bytes.size(), nullptr);
  if (zstd ? ZSTD_isError(size) != 0 : LZ4F_isError(size) != 0) throw std::bad_alloc();
  out.resize(start + size);
}

std::string Decompress(std::string_view name, std::string_view bytes, std::size_t size) {
  if (size > kLargestChunk) {
    throw ConfigError(fmt::format("chunk: got {} bytes; expected at most {}", size, kLargestChunk));
  }
  if (name == "zstd") return DecompressZstd(bytes, size);
  if (name == "lz4") return DecompressLz4(bytes, size);
  if (!name.empty()) {
    throw ConfigError(fmt::format("chunk: got compression '{}'; expected lz4 or zstd", name));
  }
  if (bytes.size() != size) throw ConfigError("chunk: its two sizes differ");
  return std::string(bytes);
}

}  // namespace oca::record
