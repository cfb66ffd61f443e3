#pragma once
// Tangents for normal maps, for meshes that bring none.

#include "scene/scene.h"

namespace lambent {

/// Fills mesh.tangents from `mesh.uvs` (or `mesh.uvs2`, for set 1), which must be there, as must
/// mesh.normals. The tangent of a vertex is the mean, weighted by angle, of the directions in which u grows
/// on the triangles around it, made perpendicular to its normal; vertices that are alike in position, normal
/// and texture coordinates count as one. Where the image is mirrored from one triangle to the next, the
/// vertices between them are doubled, so mesh's vertices may become more. After Mikkelsen, Simulation of
/// Wrinkled Surfaces Revisited, 2008.
void make_tangents(Mesh& mesh, int uv_set);

}  // namespace lambent
