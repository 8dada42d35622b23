#include <gtest/gtest.h>

#include "hal/sim/mesh.h"

// What rays meet of a mesh leads back to the very point of the triangles that are shaded.
namespace lumibox::hal::sim {
namespace {

Eigen::Vector3f point_on(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners, float u,
                         float v) {
  const auto& [a, b, c] = corners;
  return (1.0f - u - v) * mesh.positions[a] + u * mesh.positions[b] + v * mesh.positions[c];
}

class Facets : public ::testing::TestWithParam<Shape> {
 protected:
  static Mesh mesh() {
    ObjectSpec spec;
    spec.shape = GetParam();
    spec.size = {0.7, 0.4, 0.3};
    spec.segments = 20;
    spec.profile = {{0.0, 0.0}, {0.5, 0.0}, {0.3, 0.4}};
    return make_shape(spec);
  }
};

TEST_P(Facets, SpotIsWhereTheRayMetTheFacet) {
  const Mesh shape = mesh();
  for (const Facet& facet : facets(shape)) {
    // Corners and edges too, where rounding decides which triangle it is.
    for (int i = 0; i <= 12; ++i) {
      for (int j = 0; i + j <= 12; ++j) {
        const float u = static_cast<float>(i) / 12.0f;
        const float v = static_cast<float>(j) / 12.0f;
        const Facet::Spot spot = facet.spot(u, v);
        ASSERT_LT(spot.triangle, shape.triangles.size());
        EXPECT_GE(spot.u, -1e-5f);
        EXPECT_GE(spot.v, -1e-5f);
        EXPECT_LE(spot.u + spot.v, 1.0f + 1e-5f);
        const Eigen::Vector3f met = point_on(shape, facet.corners, u, v);
        const Eigen::Vector3f shaded =
            point_on(shape, shape.triangles[spot.triangle], spot.u, spot.v);
        EXPECT_LT((met - shaded).norm(), 1e-6f) << u << " " << v;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Facets,
                         ::testing::Values(Shape::Quad, Shape::Box, Shape::Sphere,
                                           Shape::Extrusion));

TEST(FacetCount, FlatRectanglesAreTwoWhateverTheirCells) {
  ObjectSpec spec;
  spec.shape = Shape::Box;
  EXPECT_EQ(facets(make_shape(spec)).size(), 12u);
  spec.displacement = {0.01, 0.1, 1};
  const Mesh bumpy = make_shape(spec);
  EXPECT_EQ(facets(bumpy).size(), bumpy.triangles.size());
}

}  // namespace
}  // namespace lumibox::hal::sim
