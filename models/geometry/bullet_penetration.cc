// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/bullet_penetration.h"

#include <BulletCollision/CollisionShapes/btConvexInternalShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <limits>

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

// Float headers over double libraries link and return garbage.
static_assert(sizeof(btScalar) == 8, "Bullet must be its double precision build");

btVector3 ToBullet(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector3d FromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btTransform ToBullet(const Eigen::Isometry3d& X) {
  const auto& R = X.linear();
  return btTransform(
      btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
      ToBullet(X.translation()));
}

// Bullet sees our own cores, through their support function and without its margins.
class CoreShape : public btConvexInternalShape {
 public:
  explicit CoreShape(const Collider& collider) : collider_(collider) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    m_collisionMargin = 0.0;
  }
  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& direction) const override {
    return ToBullet(collider_.Support(FromBullet(direction)));
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* directions,
                                                         btVector3* points,
                                                         int count) const override {
    for (int i = 0; i < count; ++i) {
      points[i] = localGetSupportingVertexWithoutMargin(directions[i]);
    }
  }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "core"; }

 private:
  const Collider& collider_;
};

}  // namespace

Vector3d BulletExit(const CorePair& pair) {
  const CoreShape a(pair.a), b(pair.b);
  const btTransform X_AA = btTransform::getIdentity();  // world = frame of A: no normal to rotate
  const btTransform X_AB = ToBullet(pair.X_AB);
  const Vector3d guesses[] = {-pair.Centre(), Vector3d::UnitX(), Vector3d::UnitY(),
                              Vector3d::UnitZ(), pair.X_AB.linear().col(2)};
  Vector3d exit = Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& guess : guesses) {
    if (guess.isZero(1e-12)) continue;
    btGjkEpaSolver2::sResults found;
    if (!btGjkEpaSolver2::Penetration(&a, X_AA, &b, X_AB, ToBullet(guess), found, false)) continue;
    const Vector3d normal = FromBullet(found.normal);
    if (!(normal.allFinite() && normal.squaredNorm() > 0.25)) continue;
    for (const Vector3d& n : {normal.normalized().eval(), (-normal).normalized().eval()}) {
      const double depth = n.dot(pair.Support(n).w);
      if (depth < least) least = depth, exit = n;
    }
  }
  return exit;
}

}  // namespace oca::geometry::internal
