// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf_meshes.h"

#include <tinyxml.h>

#include <string_view>

#include "oca/models/robot/xml_file.h"

namespace oca::robot {
namespace {

template <class Action>
void ForEach(TiXmlElement& parent, const char* name, const Action& action) {
  for (auto* e = parent.FirstChildElement(name); e != nullptr; e = e->NextSiblingElement(name)) {
    action(*e);
  }
}

}  // namespace

std::string RenameMeshes(const std::string& urdf, const std::string& where,
                         const std::function<std::string(const std::string& name)>& rename) {
  const XmlDocument document = ParseXml(urdf, where);
  bool changed = false;
  const auto rename_mesh = [&](TiXmlElement& mesh) {
    const char* const name = mesh.Attribute("filename");
    if (name == nullptr) return;
    const std::string old = name, fresh = rename(old);
    if (fresh == old) return;
    mesh.SetAttribute("filename", fresh);
    changed = true;
  };
  ForEach(*document->RootElement(), "link", [&](TiXmlElement& link) {
    for (const char* kind : {"visual", "collision"}) {
      ForEach(link, kind, [&](TiXmlElement& part) {
        ForEach(part, "geometry",
                [&](TiXmlElement& geometry) { ForEach(geometry, "mesh", rename_mesh); });
      });
    }
  });
  if (!changed) return urdf;
  TiXmlPrinter printer;
  document->Accept(&printer);
  return printer.Str();
}

}  // namespace oca::robot
