/* SPDX-License-Identifier: MIT */
/*
 * The question, and for each box of rotations its inner sums and the tree of its division. Divisions are made again,
 * and are the same: that is looked at, since the parts that decided may be those of a journal. Threads write the texts
 * of some boxes each, which go into the file in order. The first box of an orbit stands for all; of the others it is
 * told which of their parts are of the start's side.
 */
#include "plan/rigid/rigid_write.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "plan/plan_write.h"
#include "plan/rigid/inner_division.h"

/* How many boxes are written at a time. */
#define MOST_TEXTS 128

/* The text of a box. */
struct box_text {
    uint32_t leaf;
    char *text;
    size_t size;
    pir_status status;
};

struct box_texts {
    const pir_rigid_job *job; /* where each node has its root at once */
    uint32_t start, written;  /* boxes */
    struct box_text at[MOST_TEXTS];
};

/* The signs of each symmetry: three of translations, three of the robot. */
static void put_symmetries(pir_plan_writer *w, const pir_symmetries *s) {
    for (uint32_t i = 0; i < s->count; i++) {
        fputs(i == 0 ? ",\n \"symmetries\": [" : ", ", w->file);
        for (int k = 0; k < 6; k++)
            fprintf(w->file, "%s%d", k > 0 ? ", " : "[", s->signs[i] >> k & 1 ? -1 : 1);
        fputs("]", w->file);
    }
    fputs("]", w->file);
}

/* The question, with pieces that the obstacles are made of. */
static void put_question(pir_plan_writer *w, const pir_rigid_question *q, const pir_plan_pieces *obstacles) {
    const pir_plan_asked asked = {q->low,   q->high,  {q->at[0], q->at[1]}, {q->rotation[0], q->rotation[1]},
                                  q->robot, obstacles};
    pir_plan_put_asked(w, "motions", &asked);
}

/* Whether a division has the parts that a leaf has, bit for bit. */
static pir_status check_parts(const pir_box_division *division, const pir_box_parts *parts) {
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_box_parts again;
    pir_bytes bytes[2] = {{0}, {0}};
    pir_status status = pir_box_parts_keep(division, &again);
    if (status == PIR_OK && !(pir_box_parts_pack(&again, &bytes[0]) && pir_box_parts_pack(parts, &bytes[1])))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK &&
        !(bytes[0].used == bytes[1].used && memcmp(bytes[0].data, bytes[1].data, bytes[0].used) == 0))
        status = PIR_ERR_FORMAT;
    pir_bytes_finish(&bytes[0], &a);
    pir_bytes_finish(&bytes[1], &a);
    pir_box_parts_finish(&again);
    return status;
}

/* For each image of a box but itself, a letter for each node of the tree: s or o for the side of a free part. */
static void put_sides(const struct box_texts *texts, uint32_t first, pir_plan_writer *w) {
    const pir_rigid_job *job = texts->job;
    const pir_box_cell *cell = job->leaf[first].inner.cell;
    const uint32_t size = job->question->symmetries.count;
    for (uint32_t e = 1; e < size; e++) {
        fputs(e == 1 ? ",\n \"sides\": [\"" : "\", \"", w->file);
        for (uint32_t i = 0; i < w->tree->node_count; i++) {
            const pir_plan_node *node = &w->tree->node[i];
            const bool is_free = node->part == PIR_PLAN_FREE;
            const bool is_start = is_free && job->root[job->leaf[first ^ e].node + cell[node->by].part] == w->start;
            fputc(is_start ? 's' : is_free ? 'o' : '.', w->file);
        }
    }
    if (size > 1)
        fputs("\"]", w->file);
}

static void put_division(const pir_rotation_box box, const pir_plan_pieces *sums, pir_plan_writer *w) {
    int32_t low[4], high[4];
    pir_rotation_box_bounds(box, low, high);
    fputs("{\"box\": [", w->file);
    for (int c = 0; c < 4; c++)
        fprintf(w->file, "%s[%ld, %ld]", c == 0 ? "" : ", ", (long)low[c], (long)high[c]);
    fputs("]", w->file);
    pir_plan_put_pieces(w, "sums", sums);
    pir_plan_put_tree(w);
}

/* One box: the root of each of its cells is that of the node that its part is. */
static pir_status put_box(const struct box_texts *texts, uint32_t first, FILE *file) {
    const pir_rigid_job *job = texts->job;
    const pir_rigid_leaf *leaf = &job->leaf[first];
    const pir_plan_turns corners = pir_rotation_box_corners(leaf->box);
    pir_box_division division;
    pir_plan_pieces sums;
    pir_status status = pir_inner_division_again(job->question, &corners, &leaf->list, &sums, &division);
    if (status == PIR_OK)
        status = check_parts(&division, &leaf->inner);
    uint32_t *root = calloc(leaf->inner.cells > 0 ? leaf->inner.cells : 1, sizeof *root);
    uint32_t *corner = calloc(pir_plan_most_corners(&sums), sizeof *corner);
    if (status == PIR_OK && (!root || !corner))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        pir_plan_writer w = {.file = file,
                             .space = &division.space,
                             .sums = &division.sums,
                             .tree = &division.tree,
                             .root = root,
                             .start = texts->start,
                             .corner = corner};
        for (uint32_t i = 0; i < leaf->inner.cells; i++)
            root[i] = job->root[leaf->node + leaf->inner.cell[i].part];
        mpq_init(w.x);
        put_division(leaf->box, &sums, &w);
        put_sides(texts, first, &w);
        fputs("}", file);
        mpq_clear(w.x);
    }
    free(corner);
    free(root);
    pir_box_division_finish(&division);
    pir_plan_pieces_over_free(&sums);
    return status;
}

static pir_status make_text(void *data, uint32_t index) {
    struct box_texts *texts = data;
    struct box_text *own = &texts->at[index];
    FILE *file = open_memstream(&own->text, &own->size);
    own->status = file ? put_box(texts, own->leaf, file) : PIR_ERR_MEMORY;
    if (file && (ferror(file) | fclose(file)) != 0 && own->status == PIR_OK)
        own->status = PIR_ERR_MEMORY;
    return own->status;
}

static bool pack_text(void *data, uint32_t index, pir_bytes *block) {
    const struct box_text *own = &((struct box_texts *)data)->at[index];
    const pir_allocator a = pir_allocator_or_default(NULL);
    if (!pir_bytes_reserve(block, &a, own->size))
        return false;
    memcpy(block->data + block->used, own->text, own->size);
    block->used += own->size;
    return true;
}

static bool take_text(void *data, uint32_t index, pir_status status, const pir_bytes *block) {
    struct box_text *own = &((struct box_texts *)data)->at[index];
    own->text = malloc(block->used + 1);
    own->size = own->text ? block->used : 0;
    own->status = own->text ? status : PIR_ERR_MEMORY;
    if (own->size > 0)
        memcpy(own->text, block->data, own->size);
    return true;
}

static bool tell_texts(void *data, uint32_t done) {
    struct box_texts *texts = data;
    const pir_rigid_question *q = texts->job->question;
    const uint32_t written = texts->written + done * q->symmetries.count;
    return !q->progress || q->progress(q->context, texts->job->alive, written);
}

/* Writes boxes, from one on: as many as are written at a time. */
static pir_status put_some(struct box_texts *texts, uint32_t *leaf, FILE *file) {
    const pir_rigid_job *job = texts->job;
    const bool is_first = *leaf == 0;
    uint32_t count = 0;
    for (; *leaf < job->leaves && count < MOST_TEXTS; *leaf += job->question->symmetries.count)
        if (!job->leaf[*leaf].is_divided)
            texts->at[count++] = (struct box_text){.leaf = *leaf};
    const pir_block_work work = {texts, count, NULL, make_text, pack_text, take_text, tell_texts};
    pir_status status = pir_rigid_told(pir_blocks_make(job->makers, &work));
    texts->written += count * job->question->symmetries.count;
    for (uint32_t i = 0; i < count; i++) {
        struct box_text *own = &texts->at[i];
        status = status == PIR_OK ? own->status : status;
        if (status == PIR_OK) {
            fputs(is_first && i == 0 ? "\n " : ",\n ", file);
            fwrite(own->text, 1, own->size, file);
        }
        free(own->text);
    }
    return status;
}

/* Room for the corners of a facet of any piece, or NULL. */
static uint32_t *corners_of(const pir_plan_pieces *robot, const pir_plan_pieces *obstacles) {
    const uint32_t own = pir_plan_most_corners(robot), other = pir_plan_most_corners(obstacles);
    return calloc(own > other ? own : other, sizeof(uint32_t));
}

pir_status pir_rigid_write_path(const pir_rigid_question *q, const pir_rigid_result *result, FILE *file) {
    pir_plan_writer w = {.file = file, .corner = corners_of(q->robot, q->obstacles)};
    if (!w.corner)
        return PIR_ERR_MEMORY;
    mpq_init(w.x);
    put_question(&w, q, q->obstacles);
    fputs(",\n \"answer\": \"path\",\n \"path\": [", file);
    for (uint32_t i = 0; i < result->steps; i++) {
        const pir_vec3 x = result->step[i].translation;
        const pir_quat r = result->step[i].rotation;
        fprintf(file, "%s\n  {\"at\": [%.17g, %.17g, %.17g], \"quat\": [%.17g, %.17g, %.17g, %.17g]}",
                i == 0 ? "" : ",", x.x, x.y, x.z, r.x, r.y, r.z, r.w);
    }
    fputs("]}\n", file);
    mpq_clear(w.x);
    free(w.corner);
    return ferror(file) ? PIR_ERR_FILE : PIR_OK;
}

pir_status pir_rigid_write(pir_rigid_job *job, uint32_t start, FILE *file) {
    const pir_rigid_question *q = job->question;
    pir_plan_writer w = {.file = file, .start = start, .corner = corners_of(q->robot, q->wide)};
    struct box_texts texts = {.job = job, .start = start};
    pir_status status = w.corner ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t n = 0; n < job->nodes; n++)
        job->root[n] = pir_rigid_root(job->root, n);
    mpq_init(w.x);
    if (status == PIR_OK)
        put_question(&w, q, q->wide);
    if (status == PIR_OK && q->symmetries.count > 1)
        put_symmetries(&w, &q->symmetries);
    fputs(",\n \"boxes\": [", file);
    for (uint32_t leaf = 0; leaf < job->leaves && status == PIR_OK;)
        status = put_some(&texts, &leaf, file);
    fputs("]}\n", file);
    mpq_clear(w.x);
    free(w.corner);
    return status == PIR_OK && ferror(file) ? PIR_ERR_FILE : status;
}
