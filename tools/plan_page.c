/* SPDX-License-Identifier: MIT */
/*
 * The page is views/plan.html with two objects of JSON in it: the proof as it is, or null, and one which holds
 *
 *     title, about
 *     robot, obstacles   of each solid its convex pieces: points and facets, as forms.h packs them
 *     ends               two poses: x, y, z and the quaternion x, y, z, w
 *     poses              those of a path
 */
#include "plan_page.h"

#include <stdlib.h>
#include <string.h>

#include "message.h"
#include "plan_template.h"
#include "views/forms.h"

#define DATA_MARK  "@DATA@"
#define PROOF_MARK "@PROOF@"

/* Browsers take no page that is much longer. */
#define PROOF_MOST (64l << 20)

bool plan_page_add(struct plan_page *page, pir_pose pose) {
    if (page->poses == page->room) {
        const size_t room = 2 * page->room + 16;
        pir_pose *grown = realloc(page->pose, room * sizeof *grown);
        if (!grown) {
            complain_status("plan", PIR_ERR_MEMORY, NULL);
            return false;
        }
        page->pose = grown;
        page->room = room;
    }
    page->pose[page->poses++] = pose;
    return true;
}

void plan_page_clear(struct plan_page *page) {
    free(page->pose);
    page->pose = NULL;
    page->poses = page->room = 0;
}

static pir_status add_pieces(const pir_pieces *pieces, struct bytes *points, struct bytes *facets, uint64_t *count) {
    uint32_t first = 0;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < pir_pieces_count(pieces) && status == PIR_OK; i++) {
        pir_polytope *piece = NULL;
        status = pir_pieces_polytope(pieces, i, &piece);
        if (status == PIR_OK)
            status = forms_add(points, facets, piece, &first);
        *count += status == PIR_OK ? pir_polytope_facet_count(piece) : 0;
        pir_polytope_release(piece);
    }
    return status;
}

static bool print_solid(FILE *file, const pir_solid *solid) {
    struct bytes points = {0}, loops = {0}, facets = {0};
    pir_pieces *pieces = NULL;
    pir_report report = {0};
    pir_decompose_options options = pir_decompose_options_default();
    uint64_t count = 0;
    options.report = &report;
    pir_status status = pir_solid_decompose(solid, &options, NULL, &pieces);
    if (status == PIR_OK)
        status = add_pieces(pieces, &points, &loops, &count);
    bytes_add_number(&facets, count);
    bytes_add(&facets, loops.at, loops.size);
    if (status == PIR_OK && (points.failed || loops.failed || facets.failed))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        fputs("{", file);
        forms_print(file, &points, &facets);
        fputs("}", file);
    } else {
        complain_status("plan: --page", status, &report);
    }
    pir_pieces_destroy(pieces);
    free(points.at);
    free(loops.at);
    free(facets.at);
    return status == PIR_OK;
}

static void print_poses(FILE *file, const pir_pose *pose, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const pir_vec3 t = pose[i].translation;
        const pir_quat q = pose[i].rotation;
        fprintf(file, "%s[%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g]", i ? "," : "", t.x, t.y, t.z, q.x, q.y, q.z, q.w);
    }
}

static bool print_data(FILE *file, const struct plan_page *page) {
    bool done = true;
    fputs("{\"title\":", file);
    bytes_print_text(file, page->title);
    fputs(",\"about\":", file);
    bytes_print_text(file, page->about);
    fputs(",\"robot\":[", file);
    for (size_t i = 0; i < page->count && done; i++) {
        fputs(i == page->of_robot ? "],\"obstacles\":[" : i > 0 ? "," : "", file);
        done = print_solid(file, page->solid[i]);
    }
    fputs("],\"ends\":[", file);
    print_poses(file, page->end, 2);
    fputs("],\"poses\":[", file);
    print_poses(file, page->pose, page->poses);
    fputs("]}", file);
    return done;
}

static bool print_proof(FILE *file, FILE *proof) {
    char block[65536];
    size_t size;
    if (!proof) {
        fputs("null", file);
        return true;
    }
    const long length = fseek(proof, 0, SEEK_END) == 0 ? ftell(proof) : -1;
    if (length < 0) {
        complain("plan: --page: the proof cannot be read back");
        return false;
    }
    if (length > PROOF_MOST) {
        complain("plan: --page: the proof has %ld MB, more than the %ld of a page", length >> 20, PROOF_MOST >> 20);
        return false;
    }
    rewind(proof);
    while ((size = fread(block, 1, sizeof block, proof)) > 0)
        fwrite(block, 1, size, file);
    return true;
}

bool plan_page_write(FILE *file, const struct plan_page *page) {
    const char *data = strstr(plan_template, DATA_MARK), *proof = strstr(plan_template, PROOF_MARK);
    fwrite(plan_template, 1, (size_t)(data - plan_template), file);
    bool done = print_data(file, page);
    data += strlen(DATA_MARK);
    fwrite(data, 1, (size_t)(proof - data), file);
    done = done && print_proof(file, page->proof);
    fputs(proof + strlen(PROOF_MARK), file);
    return done;
}
