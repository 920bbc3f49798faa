// SPDX-License-Identifier: BSD-3-Clause
// Makes the meshes of models/robots/lwr4 from the outer measures of the KUKA LWR 4.
//
//   make_lwr4_meshes FOLDER            writes base, segment, forearm, fork, wrist and flange .stl
//   make_lwr4_meshes --check FOLDER    fails unless the files there are what it would write
//   make_lwr4_meshes --help
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

namespace {

using Point = std::array<double, 3>;

/// A closed curve at height z: |x / a|^n + |(y - y0) / b|^n = 1. Lengths in m.
struct Section {
  double z, y0, a, b, n;
};

/// One part of the arm: a surface through its sections, from the lowest to the highest.
struct Housing {
  const char* name;
  std::vector<Section> sections;
};

constexpr int kSides = 20;

constexpr const char* kUsage =
    "usage: make_lwr4_meshes FOLDER            write base, segment, forearm, fork, wrist and flange"
    " .stl\n"
    "       make_lwr4_meshes --check FOLDER    fail unless the files there are what it would "
    "write\n"
    "       make_lwr4_meshes --help\n";

// Half width of a drum of radius r about the y axis, at a distance d from that axis.
double Drum(double r, double d) { return std::sqrt(r * r - d * d); }

// Widths, reaches and lengths are those of the arm's public data sheet and drawings, to a few mm:
// housings 0.12 m wide; an elbow is two half drums side by side, one of either link, each bulging
// sideways to 0.116 m. The forearm ends below the wrist's drum and holds it from one side, by a
// fork that reaches 0.087 m: between them the flange turns freely, 0.02 m clear. Every part in the
// frame of its lower joint, z up the arm, bulging towards +y; the URDF turns them.
std::vector<Housing> Housings() {
  const double r = 0.062;  // of the elbows' drums
  const double w = 0.071;  // of the wrist's drum
  return {{"base",
           {{0.0, 0.0, 0.080, 0.080, 2.0},
            {0.015, 0.0, 0.080, 0.080, 2.0},
            {0.025, 0.0, 0.074, 0.074, 2.0},
            {0.075, 0.0, 0.066, 0.066, 2.0},
            {0.105, 0.0, 0.061, 0.061, 2.0},
            {0.119, 0.0, 0.056, 0.056, 2.0}}},
          {"segment",
           {{0.009, 0.0, 0.057, 0.057, 2.0},
            {0.025, 0.0, 0.061, 0.061, 2.0},
            {0.070, 0.004, 0.0615, 0.061, 2.0},
            {0.110, 0.022, 0.062, 0.062, 2.2},
            {0.150, 0.045, 0.062, 0.060, 2.6},
            {0.180, 0.0555, 0.062, 0.0585, 3.0},
            {0.200, 0.058, Drum(r, 0.0), 0.058, 3.0},
            {0.225, 0.058, Drum(r, 0.025), 0.057, 3.0},
            {0.243, 0.058, Drum(r, 0.043), 0.053, 3.0},
            {0.255, 0.058, Drum(r, 0.055), 0.047, 3.0},
            {0.261, 0.058, Drum(r, 0.061), 0.042, 3.0}}},
          {"forearm",
           {{0.009, 0.0, 0.057, 0.057, 2.0},
            {0.025, 0.0, 0.061, 0.061, 2.0},
            {0.055, 0.006, 0.0615, 0.067, 2.1},
            {0.075, 0.013, 0.061, 0.074, 2.3},
            {0.088, 0.013, 0.056, 0.073, 2.3},
            {0.095, 0.013, 0.045, 0.070, 2.2},
            {0.099, 0.013, 0.030, 0.064, 2.0}}},
          {"fork",
           {{0.060, 0.0740, 0.045, 0.0130, 3.0},
            {0.100, 0.0740, 0.056, 0.0130, 3.0},
            {0.150, 0.0740, 0.062, 0.0130, 3.0},
            {0.190, 0.0740, Drum(r, 0.0), 0.0130, 3.0},
            {0.215, 0.0740, Drum(r, 0.025), 0.0130, 3.0},
            {0.233, 0.0735, Drum(r, 0.043), 0.0125, 3.0},
            {0.245, 0.0725, Drum(r, 0.055), 0.0115, 3.0},
            {0.251, 0.0715, Drum(r, 0.061), 0.0105, 3.0}}},
          {"wrist",
           {{-0.070, 0.010, Drum(w, 0.070), 0.050, 3.0},
            {-0.062, 0.010, Drum(w, 0.062), 0.059, 3.0},
            {-0.045, 0.010, Drum(w, 0.045), 0.066, 2.8},
            {-0.020, 0.010, Drum(w, 0.020), 0.069, 2.6},
            {0.0, 0.010, w, 0.069, 2.5},
            {0.020, 0.009, Drum(w, 0.020), 0.066, 2.4},
            {0.040, 0.006, 0.0585, 0.057, 2.2},
            {0.059, 0.0, 0.046, 0.046, 2.0}}},
          {"flange",
           {{-0.020, 0.0, 0.038, 0.038, 2.0},
            {-0.017, 0.0, 0.040, 0.040, 2.0},
            {-0.002, 0.0, 0.040, 0.040, 2.0},
            {0.0, 0.0, 0.038, 0.038, 2.0}}}};
}

Point OnCurve(const Section& s, int side) {
  const double angle = 2.0 * std::numbers::pi * side / kSides;
  const auto power = [&s](double x) { return std::copysign(std::pow(std::abs(x), 2.0 / s.n), x); };
  return {s.a * power(std::cos(angle)), s.y0 + s.b * power(std::sin(angle)), s.z};
}

/// Triangles, counter-clockwise seen from outside.
std::vector<std::array<Point, 3>> Loft(const std::vector<Section>& sections) {
  std::vector<std::array<Point, 3>> triangles;
  for (int side = 0; side < kSides; ++side) {
    const int next = (side + 1) % kSides;
    for (std::size_t i = 0; i + 1 < sections.size(); ++i) {
      const Point a = OnCurve(sections[i], side), b = OnCurve(sections[i], next);
      const Point c = OnCurve(sections[i + 1], next), d = OnCurve(sections[i + 1], side);
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    }
    const Section& low = sections.front();
    const Section& high = sections.back();
    triangles.push_back({Point{0.0, low.y0, low.z}, OnCurve(low, next), OnCurve(low, side)});
    triangles.push_back({Point{0.0, high.y0, high.z}, OnCurve(high, side), OnCurve(high, next)});
  }
  return triangles;
}

Point Normal(const std::array<Point, 3>& t) {
  Point u{}, v{};
  for (int i = 0; i < 3; ++i) {
    u[i] = t[1][i] - t[0][i];
    v[i] = t[2][i] - t[0][i];
  }
  const Point n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  return length > 0.0 ? Point{n[0] / length, n[1] / length, n[2] / length} : Point{};
}

/// Binary STL: 80 bytes of text, the number of triangles, and for each its normal, its three
/// corners (float32, little endian) and two bytes 0.
std::vector<float> Numbers(const std::vector<std::array<Point, 3>>& triangles) {
  std::vector<float> numbers;
  for (const auto& triangle : triangles) {
    for (const double x : Normal(triangle)) numbers.push_back(static_cast<float>(x));
    for (const Point& p : triangle) {
      for (const double x : p) numbers.push_back(static_cast<float>(x));
    }
  }
  return numbers;
}

constexpr std::size_t kHeader = 84;
constexpr std::size_t kNumbersEach = 12;

std::string Stl(const std::vector<float>& numbers) {
  std::string bytes(80, ' ');
  const std::string title = "KUKA LWR 4 housing, made by make_lwr4_meshes (OCA), BSD-3-Clause";
  std::copy(title.begin(), title.end(), bytes.begin());
  const auto count = static_cast<std::uint32_t>(numbers.size() / kNumbersEach);
  bytes.append(reinterpret_cast<const char*>(&count), sizeof(count));
  for (std::size_t i = 0; i < numbers.size(); i += kNumbersEach) {
    bytes.append(reinterpret_cast<const char*>(&numbers[i]), kNumbersEach * sizeof(float));
    bytes.append(2, '\0');
  }
  return bytes;
}

/// The same up to what another mathematical library may round otherwise.
bool Same(const std::string& bytes, const std::vector<float>& expected) {
  if (bytes.size() != Stl(expected).size()) return false;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    float number = 0.0F;
    const std::size_t at = kHeader + i * sizeof(float) + 2 * (i / kNumbersEach);
    std::memcpy(&number, bytes.data() + at, sizeof(number));
    const double tolerance = i % kNumbersEach < 3 ? 1e-2 : 1e-6;  // normals of slivers turn easily
    if (!(std::abs(number - expected[i]) <= tolerance)) return false;
  }
  return true;
}

bool Handle(const Housing& housing, const std::filesystem::path& folder, bool check) {
  const std::vector<float> numbers = Numbers(Loft(housing.sections));
  const std::filesystem::path file = folder / (std::string(housing.name) + ".stl");
  if (check) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    if (Same(bytes, numbers)) return true;
    std::fprintf(stderr, "%s: is not what make_lwr4_meshes writes\n", file.c_str());
    return false;
  }
  std::ofstream out(file, std::ios::binary);
  out << Stl(numbers);
  out.close();
  if (!out) std::fprintf(stderr, "%s: cannot be written\n", file.c_str());
  return static_cast<bool>(out);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  const bool help = argc == 2 && (first == "--help" || first == "-h");
  const bool check = argc == 3 && first == "--check";
  const bool write = argc == 2 && !first.empty() && first.front() != '-';
  if (!check && !write) {
    std::fputs(kUsage, help ? stdout : stderr);
    return help ? 0 : 64;
  }
  bool fine = true;
  for (const Housing& housing : Housings()) fine = Handle(housing, argv[argc - 1], check) && fine;
  return fine ? 0 : 1;
}
