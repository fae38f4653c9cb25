/* SPDX-License-Identifier: MIT */
/*
 * The page is page.html with one object of JSON in it, which holds
 *
 *     title, total, first, every, slices   which slices of how many
 *     robot, obstacle                      the vertices of each piece, as doubles
 *     rotations                            four doubles a slice
 *     pairs: robot, obstacle, bytes        the facets of the pair's difference, slice by slice
 *
 * Arrays of doubles (least significant byte first) and bytes are in base 64. The bytes are numbers as bytes.h writes
 * them: for each slice the count of facets that go, the place of each in the list so far, less the one before and 1;
 * then the count of facets that come, for each its kind, the count of its corners and a vertex of P and one of Q for
 * each. New facets go to the end of the list. Neighbouring slices share most facets, so a slice takes few bytes.
 */
#include "page.h"

#include <stdlib.h>
#include <string.h>

#include "../message.h"
#include "../model.h"
#include "bytes.h"
#include "page_template.h"

#define DATA_MARK "@DATA@"

/* A facet as the page's numbers. */
struct item {
    const uint8_t *at;
    size_t size;
    bool shared; /* in the slice before and in this one */
};

/* The facets of one slice. */
struct list {
    struct bytes store;
    struct item *item;
    struct item **sorted; /* the same by their bytes */
    size_t count;
};

static void list_clear(struct list *list) {
    free(list->store.at);
    free(list->item);
    free(list->sorted);
    *list = (struct list){0};
}

static int compare_items(const void *a, const void *b) {
    const struct item *x = *(struct item *const *)a, *y = *(struct item *const *)b;
    size_t least = x->size < y->size ? x->size : y->size;
    int order = memcmp(x->at, y->at, least);
    return order != 0 ? order : (x->size > y->size) - (x->size < y->size);
}

/* Room for `count` facets; false when out of memory. */
static bool list_reserve(struct list *list, size_t count) {
    list->item = calloc(count + 1, sizeof *list->item);
    list->sorted = calloc(count + 1, sizeof(struct item *));
    return list->item && list->sorted;
}

static void list_sort(struct list *list) {
    for (size_t i = 0; i < list->count; i++)
        list->sorted[i] = &list->item[i];
    qsort(list->sorted, list->count, sizeof(struct item *), compare_items);
}

/* The facets of a mesh; false when out of memory. */
static bool list_of_mesh(struct list *list, const pir_mesh *mesh) {
    uint32_t facets = pir_mesh_facet_count(mesh);
    *list = (struct list){0};
    if (!list_reserve(list, facets))
        return false;
    for (uint32_t f = 0; f < facets; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        size_t start = list->store.size;
        bytes_add_number(&list->store, (uint64_t)pir_mesh_facet_kind(mesh, f));
        bytes_add_number(&list->store, count);
        for (uint32_t i = 0; i < count; i++) {
            uint32_t pair[2];
            pir_mesh_pair(mesh, corner[i], pair);
            bytes_add_number(&list->store, pair[0]);
            bytes_add_number(&list->store, pair[1]);
        }
        list->item[f].size = list->store.size - start;
    }
    if (list->store.failed)
        return false;
    const uint8_t *at = list->store.at;
    for (uint32_t f = 0; f < facets; f++) {
        list->item[f].at = at;
        at += list->item[f].size;
    }
    list->count = facets;
    list_sort(list);
    return true;
}

/* Marks what both lists have. */
static void mark_shared(struct list *before, struct list *after) {
    for (size_t i = 0; i < before->count; i++)
        before->item[i].shared = false;
    for (size_t i = 0, k = 0; i < before->count && k < after->count;) {
        int order = compare_items(&before->sorted[i], &after->sorted[k]);
        if (order == 0)
            before->sorted[i]->shared = after->sorted[k]->shared = true;
        i += order <= 0;
        k += order >= 0;
    }
}

/* Writes what goes from `before` and what comes in `after`. */
static void put_changes(struct bytes *out, const struct list *before, const struct list *after) {
    size_t gone = 0, come = 0, last = 0;
    for (size_t i = 0; i < before->count; i++)
        gone += !before->item[i].shared;
    for (size_t k = 0; k < after->count; k++)
        come += !after->item[k].shared;
    bytes_add_number(out, gone);
    for (size_t i = 0; i < before->count; i++)
        if (!before->item[i].shared) {
            bytes_add_number(out, i - last);
            last = i + 1;
        }
    bytes_add_number(out, come);
    for (size_t k = 0; k < after->count; k++)
        if (!after->item[k].shared)
            bytes_add(out, after->item[k].at, after->item[k].size);
}

/* `before` becomes the list that the page then has: what it shares with `after`, and what comes. */
static bool follow(struct list *before, const struct list *after) {
    struct list next = {0};
    bool done = list_reserve(&next, after->count);
    for (int old = 1; old >= 0; old--) {
        const struct list *from = old ? before : after;
        for (size_t i = 0; done && i < from->count; i++)
            if (from->item[i].shared == old) {
                next.item[next.count++].size = from->item[i].size;
                bytes_add(&next.store, from->item[i].at, from->item[i].size);
            }
    }
    done = done && !next.store.failed;
    const uint8_t *at = next.store.at;
    for (size_t i = 0; done && i < next.count; i++) {
        next.item[i].at = at;
        at += next.item[i].size;
    }
    if (done)
        list_sort(&next);
    list_clear(before);
    *before = next;
    return done;
}

/* The bytes of one pair of pieces; false after a complaint. */
static bool put_pair(struct bytes *out, const struct slices *slices, uint32_t pair) {
    struct list before = {0};
    bool done = true;
    for (uint64_t s = 0; done && s < slices->count; s++) {
        struct list after;
        pir_mesh *mesh = slices_mesh(slices, s, pair, PIR_DOUBLE);
        if (!mesh) {
            list_clear(&before);
            return false;
        }
        done = list_of_mesh(&after, mesh);
        if (done) {
            mark_shared(&before, &after);
            put_changes(out, &before, &after);
            done = follow(&before, &after) && !out->failed;
        }
        list_clear(&after);
        pir_mesh_destroy(mesh);
    }
    list_clear(&before);
    if (!done)
        complain("%s: out of memory", slices->path);
    return done;
}

static void print_doubles(FILE *file, const double *values, size_t count) {
    for (size_t i = 0; i < count; i += 3) {
        uint8_t bytes[24];
        size_t size = 0;
        for (size_t k = i; k < i + 3 && k < count; k++) {
            uint64_t bits;
            memcpy(&bits, &values[k], sizeof bits);
            for (int b = 0; b < 8; b++)
                bytes[size++] = (uint8_t)(bits >> 8 * b);
        }
        bytes_print(file, bytes, size);
    }
}

/* The vertices of a piece, one text. */
static bool print_body(FILE *file, const pir_polytope *body, bool first) {
    uint32_t count = pir_polytope_vertex_count(body);
    double *values = malloc(count * 3 * sizeof *values);
    if (!values) {
        complain("out of memory for a page");
        return false;
    }
    for (uint32_t v = 0; v < count; v++) {
        pir_vec3 x = pir_polytope_vertex(body, v);
        values[3 * v] = x.x;
        values[3 * v + 1] = x.y;
        values[3 * v + 2] = x.z;
    }
    fputs(first ? "\"" : ",\"", file);
    print_doubles(file, values, count * (size_t)3);
    fputs("\"", file);
    free(values);
    return true;
}

static bool print_data(FILE *file, const struct slices *slices) {
    fputs("{\"title\":", file);
    bytes_print_text(file, model_title(slices->path));
    fprintf(file, ",\"total\":%llu,\"first\":%llu,\"every\":%llu,\"slices\":%llu,\"robot\":[",
            (unsigned long long)slices->info.grid.count, (unsigned long long)slices->first,
            (unsigned long long)slices->every, (unsigned long long)slices->count);
    bool done = true;
    for (uint32_t k = 0; done && k < slices->info.robot_count; k++)
        done = print_body(file, pir_cspace_robot(slices->file, k), k == 0);
    fputs("],\"obstacle\":[", file);
    for (uint32_t l = 0; done && l < slices->info.obstacle_count; l++)
        done = print_body(file, pir_cspace_obstacle(slices->file, l), l == 0);
    fputs("],\"rotations\":\"", file);
    struct bytes rotations = {0};
    for (uint64_t s = 0; s < slices->count; s++) {
        pir_quat q = slices_rotation(slices, s);
        bytes_add(&rotations, (const double[]){q.x, q.y, q.z, q.w}, 4 * sizeof(double));
    }
    if (rotations.failed)
        complain("%s: out of memory", slices->path);
    done = done && !rotations.failed;
    if (done)
        print_doubles(file, (const double *)(const void *)rotations.at, rotations.size / sizeof(double));
    free(rotations.at);
    fputs("\",\"pairs\":[", file);
    for (uint32_t pair = 0; done && pair < slices->pairs; pair++) {
        struct bytes bytes = {0};
        done = put_pair(&bytes, slices, pair);
        fprintf(file, "%s{\"robot\":%u,\"obstacle\":%u,\"bytes\":\"", pair ? "," : "",
                pair / slices->info.obstacle_count, pair % slices->info.obstacle_count);
        bytes_print(file, bytes.at, bytes.size);
        fputs("\"}", file);
        free(bytes.at);
    }
    fputs("]}", file);
    return done;
}

bool page_write(FILE *file, const struct slices *slices) {
    const char *mark = strstr(page_template, DATA_MARK);
    fwrite(page_template, 1, (size_t)(mark - page_template), file);
    bool done = print_data(file, slices);
    fputs(mark + strlen(DATA_MARK), file);
    return done;
}
