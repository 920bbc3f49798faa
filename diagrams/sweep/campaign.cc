// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "oca/diagrams/record/record_files.h"
#include "oca/diagrams/sweep/campaign_tree.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/models/random.h"

namespace oca::sweep {
namespace {

using files::Override;
using nlohmann::ordered_json;

/// Whole numbers only.
std::optional<int> ReadIndex(std::string_view text) {
  int number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || stop != text.data() + text.size() || number < 0) return std::nullopt;
  return number;
}

/// In quotes where a shell would read anything else into it.
std::string Quoted(const std::string& word) {
  const char* const kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char letter : word)
    quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return quoted + "'";
}

class Hash {
 public:
  void Add(std::string_view bytes) {
    for (const char byte : bytes) {
      hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001B3u;
    }
    hash_ = (hash_ ^ bytes.size()) * 0x100000001B3u;  // so that "ab", "c" differs from "a", "bc"
  }
  std::string Hex() const { return fmt::format("{:016x}", hash_); }

 private:
  std::uint64_t hash_{0xCBF29CE484222325u};
};

constexpr std::int64_t kMostSamples = 1'000'000'000;

void CheckCombinations(const std::vector<Variation>& variations) {
  constexpr std::size_t kMostCombinations = 10000;
  std::size_t combinations = 1;
  for (const Variation& variation : variations) {
    if (variation.listed()) combinations *= variation.values().size();
    if (combinations > kMostCombinations) {
      throw ConfigError(fmt::format("vary: got more than {0} combinations; expected at most {0}",
                                    kMostCombinations));
    }
  }
}

ConfigError NoHeader(std::string_view line) {
  return ConfigError(fmt::format("got '{:.60}'; expected the line of a campaign", line));
}

}  // namespace

ordered_json CampaignTree(const Campaign& campaign) {
  std::vector<std::string> variations;
  for (const Variation& variation : campaign.variations) variations.push_back(variation.text());
  return {{"file", campaign.file},
          {"name", campaign.name},
          {"file_hash", campaign.file_hash},
          {"set", campaign.overrides},
          {"vary", variations},
          {"seed", campaign.seed},
          {"samples", campaign.samples},
          {"duration", campaign.duration ? ordered_json(*campaign.duration) : ordered_json()},
          {"arrival", campaign.arrival},
          {"version", campaign.version}};
}

std::string Shard::Stem() const {
  return count == 1 ? "results" : fmt::format("shard-{}-of-{}", index, count);
}

Shard Shard::Parse(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) {
    const auto index = ReadIndex(std::string_view(text).substr(0, slash));
    const auto count = ReadIndex(std::string_view(text).substr(slash + 1));
    if (index && count && *index < *count) return {*index, *count};
  }
  throw ConfigError(fmt::format("shard: got '{}'; expected I/N with 0 <= I < N, as in 0/4", text));
}

int Campaign::SeedOf(std::int64_t sample) const {
  return static_cast<int>(models::Random::Seed(seed, static_cast<std::uint64_t>(sample)) >> 33);
}

std::vector<Settings> Campaign::Combinations() const {
  std::vector<Settings> all{{}};
  for (const Variation& variation : variations) {
    if (!variation.listed()) continue;
    std::vector<Settings> longer;
    for (const Settings& shorter : all) {
      for (const std::string& value : variation.values()) {
        longer.push_back(shorter);
        longer.back().emplace_back(variation.path(), value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

Settings Campaign::Drawn(int sample_seed) const {
  Settings drawn;
  for (const Variation& variation : variations) {
    if (variation.listed()) continue;
    drawn.emplace_back(variation.path(), variation.Draw(static_cast<std::uint64_t>(sample_seed)));
  }
  return drawn;
}

std::vector<Override> Campaign::OverridesOf(int sample_seed, const Settings& combination) const {
  std::vector<Override> all;
  for (const std::string& text : overrides) all.push_back(Override::Parse(text));
  for (const auto& [path, value] : combination) all.push_back({path, value});
  for (const auto& [path, value] : Drawn(sample_seed)) all.push_back({path, value});
  all.push_back({"simulator.seed", std::to_string(sample_seed)});
  return all;
}

std::string Campaign::CommandOf(int sample_seed, const Settings& combination) const {
  std::string command = "simulator run " + Quoted(file);
  if (duration) command += fmt::format(" -t {}", *duration);
  for (const Override& one : OverridesOf(sample_seed, combination)) {
    if (one.path == "simulator.seed") {
      command += " --seed " + one.value;
    } else {
      command += " -s " + Quoted(one.path + "=" + one.value);
    }
  }
  return command;
}

void Campaign::Check() const {
  std::set<std::string> paths{"simulator.seed"};
  const auto take = [&paths](const std::string& path) {
    if (path == "simulator.seed") {
      throw ConfigError("simulator.seed: every sample has its own; expected --seed of the sweep");
    }
    if (!paths.insert(path).second) {
      throw ConfigError(fmt::format("{}: set twice; expected one -s or --vary a path", path));
    }
  };
  for (const std::string& text : overrides) take(Override::Parse(text).path);
  for (const Variation& variation : variations) take(variation.path());
  if (samples < 1 || samples > kMostSamples) {
    throw ConfigError(fmt::format("samples: got {}; expected in [1, 1e9]", samples));
  }
  if (!(arrival > 0.0 && arrival <= 1e6)) {
    throw ConfigError(fmt::format("arrival: got {}; expected in (0, 1e6]", arrival));
  }
  if (duration && !(*duration >= 0.0 && *duration <= 1e7)) {
    throw ConfigError(fmt::format("duration: got {} s; expected in [0, 1e7]", *duration));
  }
  CheckCombinations(variations);
}

std::string Campaign::Header() const {
  ordered_json json;
  json["campaign"] = CampaignTree(*this);
  return oca::internal::JsonText(json);
}

Campaign Campaign::FromHeader(const std::string& line) {
  try {
    const ordered_json json = oca::internal::ReadJsonTree(line).at("campaign");
    Campaign campaign;
    campaign.file = json.at("file");
    campaign.name = json.at("name");
    campaign.file_hash = json.at("file_hash");
    campaign.overrides = json.at("set").get<std::vector<std::string>>();
    for (const std::string text : json.at("vary")) {
      campaign.variations.push_back(Variation::Parse(text));
    }
    if (!json.at("seed").is_number_unsigned()) throw NoHeader(line);
    campaign.seed = json.at("seed");
    campaign.samples = oca::internal::WholeNumber(json.at("samples"), 0, kMostSamples);
    if (!json.at("duration").is_null()) campaign.duration = json.at("duration").get<double>();
    campaign.arrival = json.at("arrival");
    campaign.version = json.at("version");
    CheckCombinations(campaign.variations);
    return campaign;
  } catch (const ordered_json::exception&) {
    throw NoHeader(line);
  }
}

std::string Campaign::DifferenceTo(const Campaign& other) const {
  const ordered_json mine = CampaignTree(*this);
  const ordered_json its = CampaignTree(other);
  std::string differences;
  for (const auto& [key, value] : mine.items()) {
    if (key == "file" || value == its.at(key)) continue;
    differences +=
        fmt::format("{}{}: {} against {}", differences.empty() ? "" : ", ", key,
                    oca::internal::JsonText(value), oca::internal::JsonText(its.at(key)));
  }
  return differences;
}

std::vector<std::string> Inspect(Campaign& campaign, const loading::Blueprint& blueprint) {
  constexpr std::int64_t kTried = 3;
  std::vector<std::string> warnings;
  Hash hash;
  for (const Settings& combination : campaign.Combinations()) {
    for (std::int64_t sample = 0;; ++sample) {
      const int seed = campaign.SeedOf(sample);
      try {
        const auto loaded = blueprint.Build(campaign.OverridesOf(seed, combination));
        campaign.name = loaded.name;
        for (const std::string& warning : loaded.warnings) {
          const bool told = std::find(warnings.begin(), warnings.end(), warning) != warnings.end();
          if (!told) warnings.push_back(warning);
        }
        const double duration = campaign.duration.value_or(loaded.simulator.duration);
        for (const record::Attachment& file : record::FilesOf(loaded, duration)) {
          hash.Add(file.name);
          hash.Add(file.data);
        }
        break;
      } catch (const Error&) {  // a scenario may be impossible, but not all of them
        if (sample + 1 == std::min(kTried, campaign.samples)) throw;
      }
    }
  }
  campaign.file_hash = hash.Hex();
  return warnings;
}

}  // namespace oca::sweep
