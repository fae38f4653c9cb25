/* SPDX-License-Identifier: MIT */
/* The picture of two meshes: their triangles as wires, the segment between two points of theirs. */
#ifndef TOOLS_MESH_PICTURE_H
#define TOOLS_MESH_PICTURE_H

#include <stdbool.h>

#include <pirouette/trimesh_pair.h>

/* Writes an SVG file; `word` names the distance in it. False after a complaint. */
bool mesh_picture_write(const char *path, pir_trimesh *const mesh[2], const pir_pose pose[2],
                        const pir_trimesh_distance *answer, const char *word);

#endif
