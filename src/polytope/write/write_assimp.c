/* SPDX-License-Identifier: MIT */
/*
 * Writing OBJ, STL and PLY through assimp's C interface.
 *
 * A scene of one mesh of triangles, each facet a fan, is built by hand: assimp copies it before it works on it, and it
 * is freed here, never by assimp. Files are not read through assimp: on PLY files that break the format its reader may
 * loop for ever, take all memory or end the process.
 */
#include "polytope/write/write_assimp.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/report.h"

#if PIR_HAVE_ASSIMP

#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>

/* A scene of one mesh, its parts and their sizes. */
struct scene {
    struct aiScene root;
    struct aiNode node;
    struct aiMesh mesh, *meshes[1];
    struct aiMaterial material, *materials[1];
    unsigned mesh_index;
    struct aiVector3D *vertices;
    struct aiFace *faces;
    unsigned *corners;
    size_t vertex_count, face_count;
};

static pir_status make_vertices(const pir_mesh *source, struct scene *scene, const char *name, pir_report *report) {
    const pir_vec3 *points = pir_mesh_vertices(source);
    for (size_t v = 0; v < scene->vertex_count; v++) {
        struct aiVector3D p = {(ai_real)points[v].x, (ai_real)points[v].y, (ai_real)points[v].z};
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
            return pir_fail(report, PIR_ERR_ARGUMENT, "%s: vertex %zu is beyond the largest float; .off holds doubles",
                            name, v);
        scene->vertices[v] = p;
    }
    return PIR_OK;
}

/* Each facet as a fan around its first corner. */
static void make_faces(const pir_mesh *source, struct scene *scene) {
    size_t face = 0;
    for (uint32_t f = 0; f < pir_mesh_facet_count(source); f++) {
        uint32_t count;
        const uint32_t *corners = pir_mesh_facet(source, f, &count);
        for (uint32_t i = 1; i + 1 < count; i++, face++) {
            unsigned *triangle = scene->corners + 3 * face;
            triangle[0] = corners[0];
            triangle[1] = corners[i];
            triangle[2] = corners[i + 1];
            scene->faces[face] = (struct aiFace){.mNumIndices = 3, .mIndices = triangle};
        }
    }
}

/* Ties the parts together. `scene` must stay where it is. */
static void link_scene(struct scene *scene) {
    scene->mesh.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    scene->mesh.mNumVertices = (unsigned)scene->vertex_count;
    scene->mesh.mVertices = scene->vertices;
    scene->mesh.mNumFaces = (unsigned)scene->face_count;
    scene->mesh.mFaces = scene->faces;
    scene->meshes[0] = &scene->mesh;
    scene->materials[0] = &scene->material;
    // An identity transformation: the node holds the mesh as it is.
    struct aiMatrix4x4 *m = &scene->node.mTransformation;
    m->a1 = m->b2 = m->c3 = m->d4 = 1;
    scene->node.mNumMeshes = 1;
    scene->node.mMeshes = &scene->mesh_index;
    scene->root.mRootNode = &scene->node;
    scene->root.mNumMeshes = 1;
    scene->root.mMeshes = scene->meshes;
    scene->root.mNumMaterials = 1;
    scene->root.mMaterials = scene->materials;
    // Faces share vertices here; assimp must know.
    scene->root.mFlags = AI_SCENE_FLAGS_NON_VERBOSE_FORMAT;
}

static pir_status export_scene(const struct aiScene *scene, FILE *file, const char *ending, const char *name,
                               pir_report *report) {
    // OBJ without its file of materials, STL in binary, PLY as text.
    const char *format = strcmp(ending, "obj") == 0 ? "objnomtl" : strcmp(ending, "stl") == 0 ? "stlb" : "ply";
    const struct aiExportDataBlob *blob = aiExportSceneToBlob(scene, format, 0);
    if (!blob)
        return pir_fail(report, PIR_ERR_FILE, "%s: assimp cannot write it: %s", name, aiGetErrorString());
    fwrite(blob->data, 1, blob->size, file);
    aiReleaseExportBlob(blob);
    return PIR_OK;
}

pir_status pir_mesh_write_assimp(const pir_mesh *mesh, FILE *file, const char *ending, const char *name,
                                 pir_report *report) {
    if (pir_mesh_facet_count(mesh) == 0)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: .%s holds facets and a %s has none; .off holds it", name, ending,
                        pir_mesh_vertex_count(mesh) > 1 ? "segment" : "point");
    pir_allocator memory = pir_allocator_or_default(NULL);
    struct scene scene = {.vertex_count = pir_mesh_vertex_count(mesh)};
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t corners;
        pir_mesh_facet(mesh, f, &corners);
        scene.face_count += corners - 2;
    }
    scene.vertices = PIR_NEW(&memory, struct aiVector3D, scene.vertex_count);
    scene.faces = PIR_NEW(&memory, struct aiFace, scene.face_count);
    scene.corners = PIR_NEW(&memory, unsigned, 3 * scene.face_count);
    pir_status status = PIR_ERR_MEMORY;
    if (!scene.vertices || !scene.faces || !scene.corners)
        pir_fail(report, status, "%s: out of memory", name);
    else
        status = make_vertices(mesh, &scene, name, report);
    if (status == PIR_OK) {
        make_faces(mesh, &scene);
        link_scene(&scene);
        status = export_scene(&scene.root, file, ending, name, report);
    }
    PIR_FREE(&memory, scene.corners, 3 * scene.face_count);
    PIR_FREE(&memory, scene.faces, scene.face_count);
    PIR_FREE(&memory, scene.vertices, scene.vertex_count);
    return status;
}

#else

pir_status pir_mesh_write_assimp(const pir_mesh *mesh, FILE *file, const char *ending, const char *name,
                                 pir_report *report) {
    (void)mesh;
    (void)file;
    return pir_fail(report, PIR_ERR_UNSUPPORTED,
                    "%s: this build has no assimp, which writes .%s; it writes .off and .svg", name, ending);
}

#endif
