// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/loading/earlier_resolutions.h"
#include "oca/diagrams/loading/part.h"
#include "oca/diagrams/loading/told_once.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// A port of a leaf, by its path in the diagram as a whole.
template <class Handle>
struct PortAt {
  Handle handle;
  std::string path;  ///< `left.plant.position`
  bool built;        ///< whether its system is in the part that is built
};
using OutputAt = PortAt<OutputHandle>;
using InputAt = PortAt<InputHandle>;

/// A place in a diagram file, and which use of the file is meant; none of the file that is built.
struct Place {
  Location location;
  std::string use{};
};

/// What the file that is built and all those that it uses share on the way to a diagram.
class Construction {
 public:
  Construction(const Part& only, const files::Catalogue& types, EarlierResolutions& resolved,
               DiagramBuilder& builder)
      : part(only), catalogue(types), earlier(resolved), root(builder) {}

  const Part& part;
  const files::Catalogue& catalogue;
  EarlierResolutions& earlier;
  DiagramBuilder& root;  ///< of the diagram as a whole

  std::map<std::string, Place> systems{};      ///< those that could be made, by path
  std::map<std::string, Place> connections{};  ///< by the path of the input
  /// Inputs that a file leaves to the one that uses it: where the use stands, and what it calls
  /// them, by path.
  struct Open {
    Place place;
    std::string name;  ///< `left.obstacles`
  };
  std::map<std::string, Open> open{};
  ToldOnce problems{};  ///< of files that are used
  ToldOnce warnings{};  ///< of all files
  int uses{0};          ///< how many files are used

  /// A problem of the wiring lies at its connection, else at its system, else at `otherwise`. It
  /// is told with ports as the file there names them.
  void AddWiringProblem(const WiringProblem& problem, const Location& otherwise, Problems& into);
  /// A state that starts where it cannot be.
  void AddStartProblem(const SimulationError& error, Problems& into);
  /// `what` of a system that could be made, by its path.
  void AddProblemOf(const std::string& system, const std::string& what, Problems& into);

 private:
  /// The connection that is in the outermost file, the first of these on an algebraic loop; nullptr
  /// if no file makes one.
  const Place* PlaceOfConnection(const WiringProblem& problem) const;
  void Add(const Place& place, const std::string& what, Problems& into);
};

/// Where a diagram file stands in the diagram: the one that is built, or one that others use.
struct Level {
  std::string path{};                          ///< of the use: `left.hand`; empty: the one built
  std::vector<std::filesystem::path> files{};  ///< from the one that is built to this one

  /// The path of a system, or of a port, of the file.
  std::string Full(const std::string& name) const {
    return path.empty() ? name : path + "." + name;
  }
};

}  // namespace oca::loading
