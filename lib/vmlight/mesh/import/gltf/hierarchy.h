// SPDX-License-Identifier: Apache-2.0
/// The nodes of a glTF: who is whose child, where each is, and which can be seen.
#pragma once

#include <vmlight/mesh/tinygltf.h>

#include <Imath/ImathMatrix.h>

#include <string>
#include <vector>

namespace vmlight::gltf {

/// Whether brackets are nested more than 1000 deep, where readers of JSON recurse.
bool is_nested_too_deep(const std::string& json);

/// The nodes at the top of what is shown: those of the default scene, else of the first; of all nodes that have no
/// parent, if there is no scene.
std::vector<int> root_nodes(const tinygltf::Model& model);

/// Throws Error if a node does not exist, has two parents or is its own ancestor, or if the nodes under `roots` are
/// more than a million (a scene may name a root many times) or nested more than 100000 deep. Source: Khronos, glTF 2.0
/// specification, 3.5.2 (node hierarchy).
void check_hierarchy(const tinygltf::Model& model, const std::vector<int>& roots);

/// The transform of each node to the file's space, also of those in no scene. check_hierarchy() must have passed.
/// Matrices multiply row vectors, as everywhere in Imath.
std::vector<Imath::M44d> node_transforms(const tinygltf::Model& model);

/// False if KHR_node_visibility hides the node, and so all below it.
bool is_node_visible(const tinygltf::Model& model, int node);

} // namespace vmlight::gltf
