/* SPDX-License-Identifier: MIT */
/*
 * OBJ, STL and PLY through assimp's C interface.
 *
 * Reading wants points only. These three formats have no scene graph, so all vertices of all meshes are the model's points,
 * exactly as assimp holds them (floats, in its usual build). The bytes are handed over in memory, so that assimp opens no file.
 * A PLY file's counts are looked over first, since assimp believes them.
 *
 * Writing builds a scene of one mesh of triangles, each facet a fan, by hand: assimp copies it before it works on it, and it is
 * freed here by whoever made it, never by assimp.
 */
#include "polytope/io.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/report.h"

#if PIR_HAVE_ASSIMP

#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>

/* The line of `data` at `at`, leading blanks passed over; `at` moves to the next. */
static const char *next_line(const char *data, size_t size, size_t *at, size_t *ret_length) {
    while (*at < size && (data[*at] == ' ' || data[*at] == '\t'))
        ++*at;
    size_t start = *at;
    while (*at < size && data[*at] != '\n' && data[*at] != '\r')
        ++*at;
    *ret_length = *at - start;
    *at += *at + 1 < size && data[*at] == '\r' && data[*at + 1] == '\n';
    *at += *at < size;
    return data + start;
}

/* The last number in a line of a PLY header, "element vertex 8"; 2^32 when it has too many digits. */
static uint64_t last_number(const char *line, size_t length) {
    uint64_t number = 0;
    for (size_t i = 0; i < length; i++) {
        bool digit = line[i] >= '0' && line[i] <= '9';
        if (digit && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t'))
            number = 0;
        if (digit && number < (uint64_t)1 << 32)
            number = 10 * number + (uint64_t)(line[i] - '0');
    }
    return number;
}

/* Each element of a PLY file takes a byte at least, in text or binary, so a header that promises more of them lies. */
static pir_status check_ply_counts(const char *data, size_t size, const char *name, pir_report *report) {
    uint64_t promised = 0;
    size_t at = 0, length, line_number = 1;
    while (at < size) {
        const char *line = next_line(data, size, &at, &length);
        if (length >= 10 && memcmp(line, "end_header", 10) == 0)
            break;
        if (length >= 7 && memcmp(line, "element", 7) == 0)
            promised += last_number(line, length);
        if (promised > size)
            return pir_fail(report, PIR_ERR_FORMAT,
                            "%s:%zu: %llu elements are promised; the %zu bytes of the file cannot hold them", name,
                            line_number, (unsigned long long)promised, size);
        line_number++;
    }
    return PIR_OK;
}

/* The vertices of all meshes into `points`, room for all of them. */
static pir_status copy_points(const struct aiScene *scene, const char *name, pir_report *report, pir_vec3 *points) {
    size_t count = 0;
    for (unsigned m = 0; m < scene->mNumMeshes; m++) {
        const struct aiMesh *mesh = scene->mMeshes[m];
        for (unsigned v = 0; v < mesh->mNumVertices; v++) {
            const struct aiVector3D *p = &mesh->mVertices[v];
            if (!isfinite(p->x) || !isfinite(p->y) || !isfinite(p->z))
                return pir_fail(report, PIR_ERR_NOT_FINITE, "%s: point %zu has a coordinate that is not a finite float",
                                name, count);
            points[count++] = (pir_vec3){p->x, p->y, p->z};
        }
    }
    return PIR_OK;
}

pir_status pir_polytope_read_assimp(const char *data, size_t size, const char *ending, const char *name,
                                    const pir_polytope_options *options, pir_report *report,
                                    pir_polytope **ret_polytope) {
    if (strcmp(ending, "ply") == 0 && check_ply_counts(data, size, name, report) != PIR_OK)
        return PIR_ERR_FORMAT;
    const struct aiScene *scene = aiImportFileFromMemory(data, (unsigned)size, 0, ending);
    if (!scene)
        return pir_fail(report, PIR_ERR_FORMAT, "%s: assimp cannot read it: %s", name, aiGetErrorString());
    const pir_allocator memory = pir_allocator_or_default(options ? options->allocator : NULL);
    pir_status status = PIR_ERR_MEMORY;
    size_t count = 0;
    for (unsigned m = 0; m < scene->mNumMeshes; m++)
        count += scene->mMeshes[m]->mNumVertices;
    pir_vec3 *points = PIR_NEW(&memory, pir_vec3, count);
    if (!points) {
        pir_fail(report, status, "%s: out of memory", name);
        goto done;
    }
    if (count == 0) {
        status = pir_fail(report, PIR_ERR_EMPTY, "%s: the file has no points", name);
        goto done;
    }
    status = copy_points(scene, name, report, points);
    if (status != PIR_OK)
        goto done;
    status = pir_polytope_create(points, count, options, ret_polytope);
    if (status != PIR_OK)
        pir_fail(report, status, "%s: the convex hull of its points: %s", name, pir_status_text(status));
done:
    PIR_FREE(&memory, points, count);
    aiReleaseImport(scene);
    return status;
}

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

pir_status pir_polytope_read_assimp(const char *data, size_t size, const char *ending, const char *name,
                                    const pir_polytope_options *options, pir_report *report,
                                    pir_polytope **ret_polytope) {
    (void)data, (void)size, (void)options, (void)ret_polytope;
    return pir_fail(report, PIR_ERR_UNSUPPORTED, "%s: this build has no assimp, which reads .%s; it reads .off", name,
                    ending);
}

pir_status pir_mesh_write_assimp(const pir_mesh *mesh, FILE *file, const char *ending, const char *name,
                                 pir_report *report) {
    (void)mesh, (void)file;
    return pir_fail(report, PIR_ERR_UNSUPPORTED,
                    "%s: this build has no assimp, which writes .%s; it writes .off and .svg", name, ending);
}

#endif
