/* SPDX-License-Identifier: MIT */
/*
 * What Eva analyses: how polytope/read/read.h and model_make.h lead from a name, a format, options and bytes, any of
 * them, to a reader and on to a polytope. Whatever is called may fail.
 */
#include "__fc_builtin.h"

#include "base/memory.h"
#include "base/options.h"
#include "base/report.h"
#include "polytope/create/merge.h"
#include "polytope/exact_points.h"
#include "polytope/file/c_locale.h"
#include "polytope/file/file_bytes.h"
#include "polytope/read/readers.h"
#include "polytope/surface/surface.h"

static pir_status any_status(void) {
    return (pir_status)Frama_C_interval(PIR_OK, PIR_ERR_INTERNAL);
}

/* The caller's options, of this version; Frama-C has no alignof, which the function proper asks. */
pir_status pir_options_take(const char *name, const void *options, void *used, pir_report *const *report) {
    (void)name;
    (void)report;
    if (options)
        *(pir_read_options *)used = *(const pir_read_options *)options;
    return any_status();
}

pir_status pir_fail(pir_report *report, pir_status status, const char *format, ...) {
    (void)report;
    (void)format;
    return status;
}

static void *no_memory(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context;
    (void)block;
    (void)old_size;
    (void)new_size;
    return NULL;
}

pir_allocator pir_allocator_or_default(const pir_allocator *allocator) {
    return allocator ? *allocator : (pir_allocator){.resize = no_memory};
}

void pir_memory_free(const pir_allocator *allocator, void *block, size_t count, size_t size) {
    allocator->resize(allocator->context, block, count * size, 0);
}

bool pir_c_locale_enter(struct pir_c_locale *ret_locale) {
    (void)ret_locale;
    return Frama_C_interval(0, 1);
}

void pir_c_locale_leave(struct pir_c_locale *locale) {
    (void)locale;
}

/* Frama-C has its contract alone. */
char *strrchr(const char *s, int c) {
    const char *last = NULL;
    for (; *s; s++)
        if (*s == (char)c)
            last = s;
    return (char *)last;
}

/* --- files --- */

static char bytes[8];

pir_status pir_file_read(const char *path, const pir_allocator *allocator, pir_report *report,
                         struct pir_read_bytes *file) {
    (void)path;
    (void)allocator;
    (void)report;
    const pir_status status = any_status();
    if (status == PIR_OK || Frama_C_interval(0, 1))
        *file = (struct pir_read_bytes){bytes, (size_t)Frama_C_interval(0, sizeof bytes), sizeof bytes};
    return status;
}

void pir_model_init(struct pir_model *model, const char *name, const pir_allocator *allocator, pir_report *report) {
    *model = (struct pir_model){.allocator = *allocator, .name = name, .report = report};
}

void pir_model_finish(struct pir_model *model) {
    *model = (struct pir_model){0};
}

#define STAND_IN(format)                                                                                               \
    pir_status pir_read_##format(const char *data, size_t size, struct pir_model *model) {                             \
        static pir_vec3 points[4];                                                                                     \
        static mpq_t exact[12];                                                                                        \
        volatile char read = data[0];                                                                                  \
        read = data[size - 1];                                                                                         \
        model->points = points;                                                                                        \
        model->point_count = (uint32_t)Frama_C_interval(0, 4);                                                         \
        model->exact = Frama_C_interval(0, 1) ? exact : NULL;                                                          \
        return any_status();                                                                                           \
    }
PIR_READ_FORMATS(STAND_IN)

/* --- polytopes --- */

static pir_polytope hull;

pir_status pir_exact_points_of_doubles(struct pir_exact_points *exact, const pir_vec3 *points, size_t count,
                                       const pir_allocator *allocator) {
    (void)exact;
    (void)allocator;
    //@ assert count > 0;
    volatile double read = points[count - 1].z;
    (void)read;
    return any_status();
}

pir_status pir_exact_points_of_rationals(struct pir_exact_points *exact, const mpq_t *coordinates, size_t count,
                                         const pir_allocator *allocator) {
    (void)exact;
    (void)allocator;
    //@ assert count > 0;
    volatile int read = mpq_sgn(coordinates[3 * count - 1]);
    (void)read;
    return any_status();
}

void pir_exact_points_finish(struct pir_exact_points *exact, const pir_allocator *allocator) {
    (void)exact;
    (void)allocator;
}

pir_status pir_polytope_build_hull(const pir_polytope_parts *parts, const pir_allocator *allocator,
                                   pir_polytope **ret_polytope) {
    (void)parts;
    (void)allocator;
    const pir_status status = any_status();
    if (status == PIR_OK)
        *ret_polytope = &hull;
    return status;
}

void pir_polytope_release(pir_polytope *polytope) {
    (void)polytope;
}

pir_status pir_polytope_check_tolerance(double merge_tolerance) {
    (void)merge_tolerance;
    return any_status();
}

pir_status pir_surface_examine(const struct pir_model *model, const struct pir_exact_points *exact,
                               const pir_polytope *polytope, bool require_convex, pir_surface *ret_surface) {
    (void)model;
    (void)exact;
    (void)require_convex;
    //@ assert polytope == &hull;
    const pir_status status = any_status();
    if (status == PIR_OK)
        *ret_surface = (pir_surface){.points = 1};
    return status;
}

pir_status pir_polytope_merge_within(pir_polytope *polytope, double tolerance, pir_polytope **ret_polytope) {
    (void)tolerance;
    //@ assert polytope == &hull;
    *ret_polytope = polytope;
    return any_status();
}

int main(void) {
    char path[8] = {0}, format[6] = {0};
    for (size_t i = 0; i + 1 < sizeof path; i++)
        path[i] = (char)Frama_C_char_interval(-128, 127);
    for (size_t i = 0; i + 1 < sizeof format; i++)
        format[i] = (char)Frama_C_char_interval(-128, 127);
    pir_read_options options = pir_read_options_default();
    options.merge_tolerance = Frama_C_double_interval(-1, 1);
    options.require_convex = Frama_C_interval(0, 1);
    const pir_read_options *used = Frama_C_interval(0, 1) ? &options : NULL;
    const pir_file_bytes file = {bytes, (size_t)Frama_C_interval(0, sizeof bytes), Frama_C_interval(0, 1) ? path : NULL,
                                 Frama_C_interval(0, 1) ? format : NULL};
    pir_surface surface;
    pir_surface *ret_surface = Frama_C_interval(0, 1) ? &surface : NULL;
    pir_polytope *polytope = NULL;
    pir_polytope **ret_polytope = Frama_C_interval(0, 1) ? &polytope : NULL;
    return (int)pir_polytope_read(path, used, NULL, ret_surface, ret_polytope) |
           (int)pir_polytope_read(NULL, used, NULL, ret_surface, ret_polytope) |
           (int)pir_polytope_read_bytes(&file, used, NULL, ret_surface, ret_polytope) |
           (int)pir_polytope_read_bytes(NULL, used, NULL, ret_surface, ret_polytope);
}
