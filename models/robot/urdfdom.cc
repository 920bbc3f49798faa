// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdfdom.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>
#include <string>
#include <string_view>

#include "oca/models/error.h"

namespace oca::robot {
namespace {

// Keeps what urdfdom says instead of letting it print, while this object lives. The handler of
// console_bridge is global, so one thread at a time.
class CapturedLog : public console_bridge::OutputHandler {
 public:
  CapturedLog() : lock_(Mutex()) { console_bridge::useOutputHandler(this); }
  ~CapturedLog() override { console_bridge::restorePreviousOutputHandler(); }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    errors_ += (errors_.empty() ? "" : "; ") + text;
  }
  const std::string& errors() const { return errors_; }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  std::string errors_;
};

}  // namespace

std::shared_ptr<urdf::ModelInterface> ParseWithUrdfdom(const std::string& text,
                                                       const std::string& where) {
  CapturedLog log;
  std::shared_ptr<urdf::ModelInterface> parsed;
  std::string reason;
  try {
    // Without the mark of UTF-8, `&#233;` is a byte of Latin-1.
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    parsed = urdf::parseURDF(text.starts_with(kByteOrderMark) ? text
                                                              : std::string(kByteOrderMark) + text);
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (parsed == nullptr || !log.errors().empty()) {
    throw models::ModelError(fmt::format("{}: URDF; got '{}{}'; expected what urdfdom can read",
                                         where, log.errors(), reason));
  }
  return parsed;
}

Eigen::Isometry3d ToPose(const urdf::Pose& pose) {
  const auto& [x, y, z, w] = pose.rotation;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  X.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return X;
}

Eigen::Vector3d ToVector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

geometry::Shape ToPrimitive(const urdf::Geometry& geometry) {
  if (geometry.type == urdf::Geometry::SPHERE) {
    return geometry::Sphere{static_cast<const urdf::Sphere&>(geometry).radius};
  }
  if (geometry.type == urdf::Geometry::BOX) {
    return geometry::Box{ToVector(static_cast<const urdf::Box&>(geometry).dim)};
  }
  const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
  return geometry::Cylinder{cylinder.radius, cylinder.length};
}

geometry::Shape CapsuleOf(const geometry::Shape& shape) {
  const auto& cylinder = std::get<geometry::Cylinder>(shape);
  return geometry::Capsule{cylinder.radius, cylinder.length};
}

Inertia ToInertia(const urdf::Inertial& from) {
  const Eigen::Isometry3d X_LC = ToPose(from.origin);
  Eigen::Matrix3d I;
  I << from.ixx, from.ixy, from.ixz, from.ixy, from.iyy, from.iyz, from.ixz, from.iyz, from.izz;
  return {from.mass, X_LC.translation(), X_LC.linear() * I * X_LC.linear().transpose()};
}

}  // namespace oca::robot
