/* SPDX-License-Identifier: MIT */
/*
 * Faults for the command: linked with its objects and the linker's --wrap into a program of its own, which nobody
 * installs. The environment variable PIROUETTE_FAULT says which fault, and at which call: KIND:N, N from 1.
 *
 *     memory the N-th of all allocations of the command and of its calls of the library that can run out of memory does
 *     update the N-th rotation of a tracked sum goes astray walk, cgm the N-th rebuild of that kind goes astray signal
 *     SIGINT comes in the N-th rotation by PIR_METHOD_AUTO signals it comes twice there pairing the N-th comparison of
 *     two pairings says that they differ mesh the N-th comparison of two meshes says that they differ
 *
 * The linker gives __wrap_X the calls of X and calls the function itself __real_X.
 */
#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>
#include <pirouette/baseline.h>
#include <pirouette/pirouette.h>

/* The command has ended: what runs now, such as the writing of coverage, is not its own. */
static bool has_ended;

/* Whether the fault came; the file that PIROUETTE_FAULT_CAME names is made then, for the tests to see it. */
static bool has_come;

static void end(void) {
    has_ended = true;
    const char *name = getenv("PIROUETTE_FAULT_CAME");
    FILE *file = has_come && name ? fopen(name, "w") : NULL;
    if (file)
        fclose(file);
}

/* Whether this call, one of those that `kind` counts, is the one that fails. */
static bool is_due(const char *kind) {
    static unsigned long calls, due;
    static const char *chosen;
    if (has_ended)
        return false;
    if (!chosen) {
        const char *fault = getenv("PIROUETTE_FAULT");
        chosen = fault ? fault : "";
        due = *chosen ? strtoul(strchr(chosen, ':') + 1, NULL, 10) : 0;
    }
    size_t length = strlen(kind);
    if (strncmp(chosen, kind, length) != 0 || chosen[length] != ':')
        return false;
    bool comes = ++calls == due;
    has_come = has_come || comes;
    return comes;
}

/* --- memory --- */

static bool is_out_of_memory(void) {
    bool due = is_due("memory");
    if (due)
        errno = ENOMEM;
    return due;
}

void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size) {
    return is_out_of_memory() ? NULL : __real_malloc(size);
}

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size) {
    return is_out_of_memory() ? NULL : __real_calloc(count, size);
}

void *__real_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size) {
    return is_out_of_memory() ? NULL : __real_realloc(block, size);
}

char *__real_strdup(const char *text);
char *__wrap_strdup(const char *text);
char *__wrap_strdup(const char *text) {
    return is_out_of_memory() ? NULL : __real_strdup(text);
}

__attribute__((constructor)) static void start(void) {
    atexit(end);
    cJSON_InitHooks(&(cJSON_Hooks){__wrap_malloc, free});
}

/* A call of the library that may run out of memory. */
#define MAY_FAIL(name, parameters, arguments)                                                                          \
    pir_status __real_##name parameters;                                                                               \
    pir_status __wrap_##name parameters;                                                                               \
    pir_status __wrap_##name parameters {                                                                              \
        return is_due("memory") ? PIR_ERR_MEMORY : __real_##name arguments;                                            \
    }

MAY_FAIL(pir_shape_create,
         (const char *name, const pir_allocator *allocator, pir_report *report, pir_polytope **ret_polytope),
         (name, allocator, report, ret_polytope))
MAY_FAIL(pir_polytope_read,
         (const char *path, const pir_read_options *options, pir_report *report, pir_surface *ret_surface,
          pir_polytope **ret_polytope),
         (path, options, report, ret_surface, ret_polytope))
MAY_FAIL(pir_polytope_read_bytes,
         (const pir_file_bytes *file, const pir_read_options *options, pir_report *report, pir_surface *ret_surface,
          pir_polytope **ret_polytope),
         (file, options, report, ret_surface, ret_polytope))
MAY_FAIL(pir_polytope_reflect, (const pir_polytope *polytope, pir_polytope **ret_polytope), (polytope, ret_polytope))
MAY_FAIL(pir_mesh_from_polytope, (const pir_polytope *polytope, pir_mesh **ret_mesh), (polytope, ret_mesh))
MAY_FAIL(pir_mesh_write_stream,
         (const pir_mesh *mesh, FILE *file, const char *name, const char *format, int exact, pir_report *report),
         (mesh, file, name, format, exact, report))
MAY_FAIL(pir_sum_create,
         (pir_polytope * p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options, pir_sum **ret_sum),
         (p, q, rotation, options, ret_sum))
MAY_FAIL(pir_sum_set_tolerance, (pir_sum * sum, double tolerance), (sum, tolerance))
MAY_FAIL(pir_sum_set_region, (pir_sum * sum, pir_vec3 axis, double half_angle), (sum, axis, half_angle))
MAY_FAIL(pir_sum_mesh, (pir_sum * sum, pir_precision precision, pir_mesh **ret_mesh), (sum, precision, ret_mesh))
MAY_FAIL(pir_sum_rotate_brute_force, (pir_sum * sum, pir_quat rotation), (sum, rotation))
MAY_FAIL(pir_hull_sum,
         (const pir_polytope *p, const pir_polytope *q, pir_quat rotation, const pir_sum_options *options,
          pir_precision precision, pir_mesh **ret_mesh),
         (p, q, rotation, options, precision, ret_mesh))
MAY_FAIL(pir_object_sum,
         (const pir_polytope *p, const pir_polytope *q, pir_quat rotation, const pir_sum_options *options,
          pir_precision precision, pir_mesh **ret_mesh),
         (p, q, rotation, options, precision, ret_mesh))
MAY_FAIL(pir_cgm_create,
         (pir_polytope * polytope, const pir_quat *rotation, const pir_allocator *allocator, pir_cgm **ret_cgm),
         (polytope, rotation, allocator, ret_cgm))
MAY_FAIL(pir_cgm_overlay, (const pir_cgm *a, const pir_cgm *b, pir_cgm **ret_cgm), (a, b, ret_cgm))
MAY_FAIL(pir_cgm_mesh, (const pir_cgm *cgm, pir_precision precision, pir_mesh **ret_mesh), (cgm, precision, ret_mesh))
MAY_FAIL(pir_query_create, (pir_sum * sum, pir_query **ret_query), (sum, ret_query))
MAY_FAIL(pir_query_signed_distance,
         (pir_query * query, const pir_query_input *input, pir_query_cache *cache, pir_query_result *ret_result),
         (query, input, cache, ret_result))
MAY_FAIL(pir_query_directional_depth,
         (pir_query * query, const pir_query_input *input, pir_vec3 direction, pir_query_result *ret_result),
         (query, input, direction, ret_result))
MAY_FAIL(pir_query_directional_distance,
         (pir_query * query, const pir_query_input *input, pir_vec3 direction, pir_query_result *ret_result),
         (query, input, direction, ret_result))
MAY_FAIL(pir_query_cast, (pir_query * query, const pir_query_input *input, pir_vec3 motion, pir_impact *ret_result),
         (query, input, motion, ret_result))

/* --- sums that go astray, comparisons that lie --- */

/* A rotation far from the one that was asked for. */
static pir_quat astray(pir_quat q) {
    return (pir_quat){q.w + q.x, q.z - q.y, q.x - 2 * q.z, q.y + q.w};
}

pir_status __real_pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method);
pir_status __wrap_pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method);
pir_status __wrap_pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method) {
    static const char *const kinds[] = {"update", "update", "walk", "cgm"};
    if (method == PIR_METHOD_AUTO && is_due("signal"))
        raise(SIGINT);
    if (method == PIR_METHOD_AUTO && is_due("signals")) {
        raise(SIGINT);
        raise(SIGINT);
    }
    if (is_due("memory"))
        return PIR_ERR_MEMORY;
    return __real_pir_sum_rotate(sum, is_due(kinds[method]) ? astray(rotation) : rotation, method);
}

int __real_pir_sum_same_pairing(const pir_sum *a, const pir_sum *b);
int __wrap_pir_sum_same_pairing(const pir_sum *a, const pir_sum *b);
int __wrap_pir_sum_same_pairing(const pir_sum *a, const pir_sum *b) {
    return is_due("pairing") ? 0 : __real_pir_sum_same_pairing(a, b);
}

int __real_pir_mesh_equal(const pir_mesh *a, const pir_mesh *b);
int __wrap_pir_mesh_equal(const pir_mesh *a, const pir_mesh *b);
int __wrap_pir_mesh_equal(const pir_mesh *a, const pir_mesh *b) {
    return is_due("mesh") ? 0 : __real_pir_mesh_equal(a, b);
}
