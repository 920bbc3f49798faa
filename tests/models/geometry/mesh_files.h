// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace oca::geometry {

using StlTriangle = std::array<std::array<float, 3>, 3>;

/// Tetrahedron with corners 0, 1 x, 2 y, 3 z; faces outward. Volume 1.
inline std::vector<StlTriangle> Tetrahedron() {
  const std::array<float, 3> o{0, 0, 0}, x{1, 0, 0}, y{0, 2, 0}, z{0, 0, 3};
  return {{o, y, x}, {o, x, z}, {o, z, y}, {x, y, z}};
}

inline std::string BinaryStl(const std::vector<StlTriangle>& triangles,
                             const std::string& header = "binary") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  append(static_cast<std::uint32_t>(triangles.size()));
  for (const StlTriangle& triangle : triangles) {
    append(std::array<float, 3>{0, 0, 0});
    append(triangle);
    append(std::uint16_t{0});
  }
  return bytes;
}

inline std::string TextStl(const std::vector<StlTriangle>& triangles) {
  std::string text = "solid part\n";
  for (const StlTriangle& triangle : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto& p : triangle) {
      text += "vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
              std::to_string(p[2]) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

inline std::string TextObj() {
  return "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

/// A closed prism over an L, 3 m^2 by 1 m; its convex hull has half a cubic metre more.
inline std::string AngleObj() {
  std::string text;
  for (const char* z : {" 0\n", " 1\n"}) {
    for (const char* xy : {"0 0", "2 0", "2 1", "1 1", "1 2", "0 2"}) {
      text += std::string("v ") + xy + z;
    }
  }
  const auto face = [&text](int a, int b, int c) {
    text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  };
  for (int i = 2; i < 6; ++i) {
    face(1, i + 1, i);
    face(7, 6 + i, 7 + i);
  }
  for (int i = 1; i <= 6; ++i) {
    const int next = i % 6 + 1;
    face(i, next, next + 6);
    face(i, next + 6, i + 6);
  }
  return text;
}

/// The tetrahedron in Collada: `unit` in metres, `up` X_UP|Y_UP|Z_UP, `node` inside the node.
inline std::string Collada(const std::string& unit, const std::string& up,
                           const std::string& node) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>
<unit meter=")" +
         unit + R"(" name="unit"/><up_axis>)" + up + R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array>
<technique_common><accessor source="#pa" count="4" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">)" +
         node + R"(
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

}  // namespace oca::geometry
