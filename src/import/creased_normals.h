#pragma once
// Normals for meshes that come without: smooth where faces meet gently, creased where they do not.

#include "scene/scene.h"

namespace lambent {

/// Gives `mesh` normals, in place of any that it has. Around each position, faces that share an edge and
/// whose normals differ by at most `crease` degrees belong together; a group's normal is the sum of its
/// faces' normals, each as long as its face is large, so that large flat faces stay flat beside small rounded
/// ones. Vertices at one position count as one, and a vertex between several groups is split. Where nothing
/// is curved, the mesh stays as it is, without normals: its faces' own are right.
///
/// Every triangle must have an area. Where vertices and corners of triangles together are 2^32 or more, the
/// mesh stays without normals.
void add_creased_normals(Mesh& mesh, double crease);

}  // namespace lambent
