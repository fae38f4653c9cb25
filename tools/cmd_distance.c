/* SPDX-License-Identifier: MIT */
/* pirouette distance: two meshes of triangles as they are, A turned and moved: how near, how far, what is near. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "args.h"
#include "cmd.h"
#include "input.h"
#include "json.h"
#include "measure.h"
#include "mesh_picture.h"
#include "message.h"
#include "model.h"
#include "pose.h"
#include "target.h"

struct request {
    pir_pose pose[2];
    bool farthest, has_within;
    double within;
};

struct answer {
    pir_trimesh_distance distance;
    pir_triangle_pair *pairs; /* those within, where they are asked for */
    size_t count;
    double seconds; /* from the meshes to the answer */
};

/* --- meshes --- */

static pir_status read_stdin(pir_trimesh **ret_mesh) {
    pir_file_bytes file;
    pir_report report = {0};
    if (!input_begin_model(&file))
        return PIR_ERR_FILE;
    const pir_status status = pir_trimesh_read_bytes(&file, NULL, &report, ret_mesh);
    return input_end_model(&file, status, &report);
}

/* A facet's corners, in a fan. */
static uint32_t fan(const pir_polytope *shape, uint32_t facet, uint32_t *corners, uint32_t (*triangle)[3]) {
    uint32_t size = pir_polytope_facet_size(shape, facet);
    pir_polytope_facet(shape, facet, corners);
    for (uint32_t i = 0; i + 2 < size; i++) {
        triangle[i][0] = corners[0];
        triangle[i][1] = corners[i + 1];
        triangle[i][2] = corners[i + 2];
    }
    return size > 2 ? size - 2 : 0;
}

static pir_status mesh_of_polytope(const pir_polytope *shape, pir_report *report, pir_trimesh **ret_mesh) {
    uint32_t vertices = pir_polytope_vertex_count(shape), edges = pir_polytope_edge_count(shape);
    pir_vec3 *vertex = malloc(vertices * sizeof *vertex);
    uint32_t *corners = malloc(vertices * sizeof *corners), count = 0;
    // a polygon of k sides makes k − 2 triangles, and each edge is a side of two
    uint32_t(*triangle)[3] = malloc((2 * (size_t)edges + 1) * sizeof *triangle);
    pir_status status = PIR_ERR_MEMORY;
    if (vertex && corners && triangle) {
        for (uint32_t v = 0; v < vertices; v++)
            vertex[v] = pir_polytope_vertex(shape, v);
        for (uint32_t f = 0; f < pir_polytope_facet_count(shape); f++)
            count += fan(shape, f, corners, triangle + count);
        pir_trimesh_arrays arrays = {
            .vertices = vertex, .vertex_count = vertices, .triangles = triangle[0], .triangle_count = count};
        status = pir_trimesh_create(&arrays, NULL, report, ret_mesh);
    }
    free(vertex);
    free(corners);
    free(triangle);
    return status;
}

static pir_trimesh *load(const char *model) {
    pir_trimesh *mesh = NULL;
    pir_report report = {0};
    if (input_is_stdin(model))
        return read_stdin(&mesh) == PIR_OK ? mesh : NULL;
    pir_status status;
    if (strncmp(model, MODEL_SHAPE, strlen(MODEL_SHAPE)) == 0) {
        pir_polytope *shape = NULL;
        status = pir_shape_create(model + strlen(MODEL_SHAPE), NULL, &report, &shape);
        if (status == PIR_OK)
            status = mesh_of_polytope(shape, &report, &mesh);
        pir_polytope_release(shape);
    } else {
        status = pir_trimesh_read(model, NULL, &report, &mesh);
    }
    if (status != PIR_OK)
        complain_status(model, status, &report);
    return status == PIR_OK ? mesh : NULL;
}

/* --- answers --- */

static bool read_request(const struct args *args, struct request *request) {
    *request = (struct request){.pose = {pir_pose_identity(), pir_pose_identity()}};
    double t[3] = {0, 0, 0};
    if (!pose_read(args, &request->pose[0].rotation) || !args_numbers(args, "--translate", 3, t) ||
        !args_numbers(args, "--within", 1, &request->within))
        return false;
    request->pose[0].translation = (pir_vec3){t[0], t[1], t[2]};
    request->farthest = args_has(args, "--farthest");
    request->has_within = args_has(args, "--within");
    if (request->within < 0) {
        complain("distance: --within: %s is less than 0", args_value(args, "--within"));
        return false;
    }
    return target_check(args, "-o", ".svg");
}

/* The pairs of triangles within the length, counted first, then listed. */
static pir_status ask_within(pir_trimesh_pair *pair, const struct request *request, struct answer *answer) {
    const pir_within_input input = {request->pose[0], request->pose[1], request->within};
    pir_status status = pir_trimesh_pair_within(pair, &input, 0, NULL, &answer->count);
    if (status != PIR_OK || answer->count == 0)
        return status;
    answer->pairs = malloc(answer->count * sizeof *answer->pairs);
    return answer->pairs ? pir_trimesh_pair_within(pair, &input, answer->count, answer->pairs, &answer->count)
                         : PIR_ERR_MEMORY;
}

static pir_status ask(pir_trimesh *const mesh[2], const struct request *request, struct answer *answer) {
    pir_trimesh_pair *pair = NULL;
    int64_t start = clock_now();
    pir_status status = pir_trimesh_pair_create(mesh[0], mesh[1], NULL, &pair);
    if (status == PIR_OK)
        status = request->farthest
                     ? pir_trimesh_pair_farthest(pair, request->pose[0], request->pose[1], &answer->distance)
                     : pir_trimesh_pair_nearest(pair, request->pose[0], request->pose[1], &answer->distance);
    if (status == PIR_OK && request->has_within)
        status = ask_within(pair, request, answer);
    answer->seconds = (double)(clock_now() - start) / 1e9;
    pir_trimesh_pair_destroy(pair);
    return status;
}

/* --- printing --- */

static const char *const states[] = {"apart", "meet", "a inside", "b inside"};

static void add_mesh(struct json *json, const char *name, const char *model, const pir_trimesh *mesh) {
    pir_trimesh_info info;
    pir_trimesh_describe(mesh, &info);
    cJSON *object = json_add_object(json, json->root, name);
    json_add_text(json, object, "model", model);
    json_add_count(json, object, "triangles", info.triangles);
    json_add_count(json, object, "degenerate", info.degenerate);
    json_add_flag(json, object, "closed", info.closed);
}

static void add_vector(struct json *json, cJSON *parent, const char *name, pir_vec3 v) {
    // + 0.0 turns −0 into 0
    const double numbers[3] = {v.x + 0.0, v.y + 0.0, v.z + 0.0};
    json_add_numbers(json, parent, name, numbers, 3);
}

static bool print_json(const struct args *args, pir_trimesh *const mesh[2], const struct request *request,
                       const struct answer *answer) {
    const pir_trimesh_distance *d = &answer->distance;
    struct json json = json_new();
    add_mesh(&json, "a", args->positional[0], mesh[0]);
    add_mesh(&json, "b", args->positional[1], mesh[1]);
    if (!request->farthest)
        json_add_text(&json, json.root, "state", states[d->state]);
    json_add_number(&json, json.root, request->farthest ? "farthest" : "distance", d->distance);
    const double triangles[2] = {d->triangle_p, d->triangle_q};
    json_add_numbers(&json, json.root, "triangles", triangles, 2);
    cJSON *points = json_add_object(&json, json.root, "points");
    add_vector(&json, points, "a", d->point_p);
    add_vector(&json, points, "b", d->point_q);
    if (request->has_within) {
        cJSON *within = json_add_object(&json, json.root, "within");
        json_add_number(&json, within, "distance", request->within);
        json_add_count(&json, within, "count", answer->count);
        cJSON *pairs = json_add_array(&json, within, "pairs");
        for (size_t i = 0; i < answer->count; i++) {
            const double pair[2] = {answer->pairs[i].p, answer->pairs[i].q};
            json_add_numbers(&json, pairs, NULL, pair, 2);
        }
    }
    json_add_number(&json, json.root, "seconds", answer->seconds);
    return json_print(&json, stdout);
}

static void print_vector(const char *name, pir_vec3 v) {
    say("  %-12s %.17g, %.17g, %.17g\n", name, v.x, v.y, v.z);
}

static void print_text(const struct args *args, const struct request *request, const struct answer *answer) {
    const pir_trimesh_distance *d = &answer->distance;
    say("%s against %s: %s\n", args->positional[0], args->positional[1],
        request->farthest ? "farthest points" : states[d->state]);
    say("  %-12s %.17g\n", "distance", d->distance);
    say("  %-12s %u, %u\n", "triangles", (unsigned)d->triangle_p, (unsigned)d->triangle_q);
    print_vector("point of A", d->point_p);
    print_vector("point of B", d->point_q);
    if (request->has_within)
        say("  %-12s %zu pairs of triangles\n", "within", answer->count);
    if (args_has(args, "-o"))
        say("  %-12s %s\n", "file", args_value(args, "-o"));
}

static int give(const struct args *args, pir_trimesh *const mesh[2], const struct request *request,
                const struct answer *answer) {
    const char *file = args_value(args, "-o");
    if (file &&
        !mesh_picture_write(file, mesh, request->pose, &answer->distance, request->farthest ? "farthest" : "distance"))
        return EXIT_BAD_INPUT;
    if (args_has(args, "--json"))
        return print_json(args, mesh, request, answer) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (!target_is_stdout(args, "-o"))
        print_text(args, request, answer);
    return EXIT_DONE;
}

SUBCOMMAND(distance) {
    struct request request;
    if (!read_request(args, &request))
        return EXIT_BAD_INPUT;
    int result = EXIT_BAD_INPUT;
    pir_trimesh *mesh[2] = {load(args->positional[0]), NULL};
    if (mesh[0])
        mesh[1] = load(args->positional[1]);
    struct answer answer = {.count = 0};
    if (mesh[0] && mesh[1]) {
        pir_status status = ask(mesh, &request, &answer);
        if (status == PIR_OK)
            result = give(args, mesh, &request, &answer);
        else
            complain_status("distance", status, NULL);
    }
    free(answer.pairs);
    pir_trimesh_release(mesh[1]);
    pir_trimesh_release(mesh[0]);
    return result;
}
