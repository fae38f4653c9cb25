/* SPDX-License-Identifier: MIT */
/* See rigid_boxes.h. */
#include "plan/rigid/rigid_boxes.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
/* How often a box may be asked to block more, and of how many translations for each link. */
#define MOST_ROUNDS 6
#define MOST_SHARED 64

bool pir_rigid_grow(pir_rigid_job *job, void **array, uint32_t *room, uint32_t need, size_t size) {
    if (job->status == PIR_OK && need > *room) {
        const uint32_t larger = need + need / 2 + 16;
        void *grown = realloc(*array, larger * size);
        if (grown) {
            *array = grown;
            *room = larger;
        } else {
            job->status = PIR_ERR_MEMORY;
        }
    }
    return job->status == PIR_OK;
}

uint32_t pir_rigid_root(uint32_t *root, uint32_t i) {
    while (root[i] != i)
        i = root[i] = root[root[i]];
    return i;
}

/* --- which touch --- */

static void add_touch(pir_rigid_job *job, uint32_t leaf, uint32_t other) {
    pir_rigid_leaf *own = &job->leaf[leaf];
    if (pir_rigid_grow(job, (void **)&own->touch, &own->room, own->touches + 1, sizeof *own->touch))
        own->touch[own->touches++] = (pir_rigid_touch){other, 0, NULL, false};
}

static void drop_touch(pir_rigid_leaf *own, uint32_t other) {
    for (uint32_t i = 0; i < own->touches; i++)
        if (own->touch[i].other == other) {
            free(own->touch[i].link);
            own->touch[i] = own->touch[--own->touches];
            return;
        }
}

static void touch_both(pir_rigid_job *job, uint32_t a, uint32_t b) {
    if (pir_rotation_boxes_touch(job->leaf[a].box, job->leaf[b].box)) {
        add_touch(job, a, b);
        add_touch(job, b, a);
    }
}

static uint32_t add_leaf(pir_rigid_job *job, pir_rotation_box box, uint32_t parent) {
    if (!pir_rigid_grow(job, (void **)&job->leaf, &job->leaf_room, job->leaves + 1, sizeof *job->leaf))
        return PIR_PLAN_NONE;
    job->leaf[job->leaves] = (pir_rigid_leaf){.box = box, .parent = parent};
    job->alive++;
    return job->leaves++;
}

void pir_rigid_boxes_begin(pir_rigid_job *job) {
    for (uint32_t i = 0; i < PIR_ROTATION_ROOTS && job->status == PIR_OK; i++) {
        const uint32_t leaf = add_leaf(job, pir_rotation_box_root(i), PIR_PLAN_NONE);
        for (uint32_t k = 0; k < leaf && job->status == PIR_OK; k++)
            touch_both(job, leaf, k);
    }
}

static void free_links(pir_rigid_leaf *leaf) {
    for (uint32_t i = 0; i < leaf->touches; i++)
        free(leaf->touch[i].link);
    free(leaf->touch);
    leaf->touch = NULL;
    leaf->touches = leaf->room = 0;
}

static void free_asks(pir_rigid_leaf *leaf) {
    free(leaf->ask);
    free(leaf->shared);
    leaf->ask = NULL;
    leaf->shared = NULL;
    leaf->asks = leaf->ask_room = leaf->shareds = leaf->shared_room = 0;
}

/* Has the leaves from one on stand for another, which they are parts of. */
static void replace(pir_rigid_job *job, uint32_t leaf, uint32_t first) {
    for (uint32_t t = 0; t < job->leaf[leaf].touches && job->status == PIR_OK; t++) {
        const uint32_t other = job->leaf[leaf].touch[t].other;
        drop_touch(&job->leaf[other], leaf);
        for (uint32_t i = 0; first + i < job->leaves && job->status == PIR_OK; i++)
            touch_both(job, first + i, other);
    }
    for (uint32_t i = 0; first + i < job->leaves && job->status == PIR_OK; i++)
        for (uint32_t k = 0; k < i; k++)
            touch_both(job, first + i, first + k);
    pir_rigid_leaf *old = &job->leaf[leaf];
    free_links(old);
    job->kept -= pir_box_parts_size(&old->inner) + pir_inner_list_size(&old->list);
    pir_box_parts_finish(&old->inner);
    pir_inner_list_finish(&old->list);
    free_asks(old);
    old->is_divided = true;
    job->alive--;
}

void pir_rigid_box_divide(pir_rigid_job *job, uint32_t leaf) {
    const uint32_t first = job->leaves;
    const pir_rotation_box box = job->leaf[leaf].box;
    for (uint32_t i = 0; i < 8; i++)
        add_leaf(job, pir_rotation_box_child(box, i), leaf);
    replace(job, leaf, first);
}

void pir_rigid_box_refine(pir_rigid_job *job, uint32_t leaf) {
    const uint32_t made = add_leaf(job, job->leaf[leaf].box, job->leaf[leaf].parent);
    if (made == PIR_PLAN_NONE)
        return;
    pir_rigid_leaf *own = &job->leaf[made], *old = &job->leaf[leaf];
    if (!pir_inner_list_copy(&old->list, &own->list))
        job->status = PIR_ERR_MEMORY;
    own->list.rounds++;
    own->shared = old->shared;
    own->shareds = old->shareds;
    old->shared = NULL;
    own->is_full = old->is_full;
    own->middle = old->middle;
    own->hub = old->hub;
    own->hubs = old->hubs;
    own->hub_room = old->hub_room;
    old->middle = (pir_box_parts){0};
    old->hub = NULL;
    old->hubs = old->hub_room = 0;
    old->is_full = false;
    replace(job, leaf, made);
}

bool pir_rigid_box_may_refine(const pir_rigid_leaf *leaf) {
    return !leaf->is_open && !leaf->is_spent && leaf->list.rounds < MOST_ROUNDS;
}

/* --- parts --- */

/* Notes which parts have the translations of the ends, about: the box is open where one has both, or none has one. */
static void note_ends(const pir_rigid_question *question, pir_rigid_leaf *leaf) {
    const pir_box_parts *parts = &leaf->inner;
    leaf->end[0] = leaf->end[1] = PIR_PLAN_NONE;
    for (uint32_t i = 0; i < parts->cells; i++)
        for (int s = 0; s < 2; s++)
            if (pir_box_cell_has(parts, &parts->cell[i], question->at[s]))
                leaf->end[s] = parts->cell[i].part;
    leaf->is_open = leaf->end[0] == leaf->end[1] || leaf->end[0] == PIR_PLAN_NONE || leaf->end[1] == PIR_PLAN_NONE;
}

/* The blocks of a box; those of rounds follow. */
enum box_block { INNER_BLOCK, MIDDLE_BLOCK };

static uint64_t block_number(pir_rotation_box box, uint32_t kind) {
    uint64_t number = (uint64_t)kind << 2 | box.chart;
    number = number << 5 | box.level;
    for (int k = 0; k < 3; k++)
        number = number << PIR_ROTATION_LEVELS | box.at[k];
    return number;
}

static pir_rigid_leaf *new_leaf(void *data, uint32_t index) {
    const pir_rigid_job *job = data;
    return &job->leaf[job->first_new + index];
}

static uint64_t leaf_number(void *data, uint32_t index) {
    const pir_rigid_leaf *leaf = new_leaf(data, index);
    const uint32_t rounds = leaf->list.rounds;
    return block_number(leaf->box, rounds > 0 ? MIDDLE_BLOCK + rounds : INNER_BLOCK);
}

/* The block of a leaf begins with this; its list follows, and its parts. */
struct packed_leaf {
    uint64_t asked; /* a hash of what it was to block: another budget may have asked otherwise */
    uint64_t is_spent;
};

static struct packed_leaf pack_head(const pir_rigid_leaf *leaf) {
    const uint64_t hash = pir_hash_words(PIR_HASH_START, leaf->shared, leaf->shareds * sizeof *leaf->shared);
    return (struct packed_leaf){hash, leaf->is_spent};
}

static bool pack_leaf(void *data, uint32_t index, pir_bytes *block) {
    const pir_rigid_leaf *leaf = new_leaf(data, index);
    const struct packed_leaf head = pack_head(leaf);
    const pir_allocator a = pir_allocator_or_default(NULL);
    if (!pir_bytes_reserve(block, &a, sizeof head))
        return false;
    memcpy(block->data + block->used, &head, sizeof head);
    block->used += sizeof head;
    return pir_inner_list_pack(&leaf->list, block) && pir_box_parts_pack(&leaf->inner, block);
}

static bool tell_leaves(void *data, uint32_t done) {
    const pir_rigid_job *job = data;
    const pir_rigid_question *q = job->question;
    return !q->progress || q->progress(q->context, job->alive - (job->leaves - job->first_new - done), 0);
}

/* Takes a list and parts of bytes; false where they are none, or of what was asked otherwise. */
static bool unpack_leaf(const pir_rigid_job *job, const pir_bytes *block, pir_rigid_leaf *leaf) {
    const uint32_t pairs = job->question->robot->count * job->question->wide->count;
    struct packed_leaf head;
    pir_inner_list list = {0};
    if (block->used < sizeof head)
        return false;
    memcpy(&head, block->data, sizeof head);
    const size_t rest = block->used - sizeof head;
    pir_bytes bytes = {block->data + sizeof head, rest, rest};
    const bool good = head.asked == pack_head(leaf).asked && pir_inner_list_unpack(&bytes, pairs, &list) &&
                      list.rounds == leaf->list.rounds && pir_box_parts_unpack(&bytes, &leaf->inner);
    pir_inner_list *old = good ? &leaf->list : &list;
    pir_inner_list_finish(old);
    if (good) {
        leaf->list = list;
        leaf->is_spent = head.is_spent != 0;
    } else {
        pir_box_parts_finish(&leaf->inner);
    }
    return good;
}

static bool take_leaf(void *data, uint32_t index, pir_status status, const pir_bytes *block) {
    const pir_rigid_job *job = data;
    pir_rigid_leaf *leaf = new_leaf(data, index);
    leaf->status = status;
    const bool good = status != PIR_OK || unpack_leaf(job, block, leaf);
    note_ends(job->question, leaf);
    return good;
}

static pir_status make_leaf(void *data, uint32_t index) {
    const pir_rigid_job *job = data;
    pir_rigid_leaf *leaf = new_leaf(data, index);
    const pir_plan_turns corners = pir_rotation_box_corners(leaf->box);
    const uint32_t old = leaf->list.pairs + leaf->list.points;
    pir_plan_pieces sums;
    pir_box_division division;
    leaf->status = pir_inner_division_make(job->question, &corners, (const double(*)[3])leaf->shared, leaf->shareds,
                                           &leaf->list, &sums, &division);
    if (leaf->status == PIR_OK)
        leaf->status = pir_box_parts_keep(&division, &leaf->inner);
    note_ends(job->question, leaf);
    leaf->is_spent = leaf->list.rounds > 0 && leaf->list.pairs + leaf->list.points == old;
    pir_box_division_finish(&division);
    pir_plan_pieces_over_free(&sums);
    return leaf->status;
}

static pir_rigid_leaf *listed_leaf(void *data, uint32_t index) {
    const pir_rigid_job *job = data;
    return &job->leaf[job->list[index]];
}

static uint64_t middle_number(void *data, uint32_t index) {
    return block_number(listed_leaf(data, index)->box, MIDDLE_BLOCK);
}

static bool pack_middle(void *data, uint32_t index, pir_bytes *block) {
    return pir_box_parts_pack(&listed_leaf(data, index)->middle, block);
}

/* Notes how a middle was made; a robot that is too thin for outer pieces has no hubs. */
static pir_status note_middle(pir_rigid_leaf *leaf, pir_status status) {
    leaf->is_full = status == PIR_OK;
    leaf->status = status == PIR_ERR_LIMIT ? PIR_OK : status;
    return status;
}

static bool take_middle(void *data, uint32_t index, pir_status status, const pir_bytes *block) {
    pir_rigid_leaf *leaf = listed_leaf(data, index);
    const bool good = status != PIR_OK || pir_box_parts_unpack(block, &leaf->middle);
    if (good)
        note_middle(leaf, status);
    else
        pir_box_parts_finish(&leaf->middle);
    return good;
}

static pir_status fill_leaf(void *data, uint32_t index) {
    const pir_rigid_job *job = data;
    pir_rigid_leaf *leaf = listed_leaf(data, index);
    const pir_plan_turns middle = {{pir_rotation_box_middle(leaf->box)}, 1};
    pir_plan_pieces outer;
    pir_status status = pir_plan_pieces_over(job->question->robot, &middle, true, &outer);
    if (status == PIR_OK) {
        pir_box_division division;
        status = pir_box_division_make(job->question, &outer, false, &division);
        if (status == PIR_OK)
            status = pir_box_parts_keep(&division, &leaf->middle);
        pir_box_division_finish(&division);
    }
    pir_plan_pieces_over_free(&outer);
    return note_middle(leaf, status);
}

/* --- links --- */

/* Whether parts of two leaves may share a translation. */
static bool parts_meet(const pir_box_parts *a, uint32_t part_a, const pir_box_parts *b, uint32_t part_b) {
    for (uint32_t i = 0; i < a->cells; i++)
        for (uint32_t k = 0; k < b->cells && a->cell[i].part == part_a; k++)
            if (b->cell[k].part == part_b && pir_box_cells_meet(a, &a->cell[i], b, &b->cell[k], NULL))
                return true;
    return false;
}

static pir_status link_two(const pir_box_parts *a, const pir_box_parts *b, pir_rigid_touch *touch) {
    uint32_t room = 0;
    for (uint32_t i = 0; i < a->parts; i++)
        for (uint32_t k = 0; k < b->parts; k++) {
            if (!parts_meet(a, i, b, k))
                continue;
            if (touch->links == room) {
                room = 2 * room + 2;
                uint32_t(*grown)[2] = realloc(touch->link, room * sizeof *grown);
                if (!grown)
                    return PIR_ERR_MEMORY;
                touch->link = grown;
            }
            touch->link[touch->links][0] = i;
            touch->link[touch->links++][1] = k;
        }
    touch->is_linked = true;
    return PIR_OK;
}

static void link_leaf(void *data, uint32_t index) {
    pir_rigid_job *job = data;
    const uint32_t own = job->first_new + index;
    pir_rigid_leaf *leaf = &job->leaf[own];
    for (uint32_t i = 0; i < leaf->touches && leaf->status == PIR_OK; i++) {
        pir_rigid_touch *touch = &leaf->touch[i];
        if (touch->other < own && !touch->is_linked)
            leaf->status = link_two(&leaf->inner, &job->leaf[touch->other].inner, touch);
    }
}

/* Adds translations that two parts share. */
static void list_shared(pir_rigid_leaf *leaf, const pir_rigid_ask *ask, const pir_box_parts *other) {
    const pir_box_parts *own = &leaf->inner;
    const uint32_t most = leaf->shareds + MOST_SHARED;
    for (uint32_t i = 0; i < own->cells; i++)
        for (uint32_t k = 0; k < other->cells && own->cell[i].part == ask->part; k++) {
            double x[3];
            if (other->cell[k].part == ask->other_part && leaf->shareds < most &&
                pir_box_cells_meet(own, &own->cell[i], other, &other->cell[k], x))
                memcpy(leaf->shared[leaf->shareds++], x, sizeof x);
        }
}

static void look_leaf(void *data, uint32_t index) {
    pir_rigid_leaf *leaf = listed_leaf(data, index);
    const pir_rigid_job *job = data;
    for (uint32_t i = 0; i < leaf->asks; i++)
        list_shared(leaf, &leaf->ask[i], &job->leaf[leaf->ask[i].other].inner);
}

void pir_rigid_boxes_ask(pir_rigid_job *job) {
    const pir_tasks tasks = job->makers->tasks;
    for (uint32_t i = 0; i < job->listed; i++) {
        pir_rigid_leaf *leaf = &job->leaf[job->list[i]];
        if (!pir_rigid_grow(job, (void **)&leaf->shared, &leaf->shared_room, leaf->asks * MOST_SHARED,
                            sizeof *leaf->shared))
            return;
    }
    tasks.start(tasks.context, look_leaf, job, job->listed);
    tasks.finish(tasks.context);
}

/* Counts what a division left. */
static void count_parts(pir_rigid_job *job, const pir_box_parts *parts) {
    job->parts += parts->nodes;
    job->kept += pir_box_parts_size(parts);
    if (job->kept > job->question->memory && job->status == PIR_OK)
        job->status = PIR_ERR_LIMIT;
}

void pir_rigid_boxes_make(pir_rigid_job *job) {
    const uint32_t count = job->leaves - job->first_new;
    const pir_tasks tasks = job->makers->tasks;
    const pir_block_work work = {job, count, leaf_number, make_leaf, pack_leaf, take_leaf, tell_leaves};
    job->status = pir_blocks_make(job->makers, &work);
    for (uint32_t i = job->first_new; i < job->leaves && job->status == PIR_OK; i++) {
        job->status = job->leaf[i].status;
        job->kept += pir_inner_list_size(&job->leaf[i].list);
        count_parts(job, &job->leaf[i].inner);
        free_asks(&job->leaf[i]);
    }
    if (job->status != PIR_OK)
        return;
    tasks.start(tasks.context, link_leaf, job, count);
    tasks.finish(tasks.context);
    for (uint32_t i = job->first_new; i < job->leaves && job->status == PIR_OK; i++)
        job->status = job->leaf[i].status;
}

void pir_rigid_boxes_fill(pir_rigid_job *job) {
    const pir_block_work work = {job, job->listed, middle_number, fill_leaf, pack_middle, take_middle, NULL};
    job->status = pir_blocks_make(job->makers, &work);
    for (uint32_t i = 0; i < job->listed && job->status == PIR_OK; i++) {
        job->status = job->leaf[job->list[i]].status;
        count_parts(job, &job->leaf[job->list[i]].middle);
    }
}

void pir_rigid_boxes_join(pir_rigid_job *job) {
    job->nodes = 0;
    for (uint32_t i = 0; i < job->leaves; i++)
        if (!job->leaf[i].is_divided) {
            job->leaf[i].node = job->nodes;
            job->nodes += job->leaf[i].inner.parts;
        }
    if (!pir_rigid_grow(job, (void **)&job->root, &job->root_room, job->nodes, sizeof *job->root))
        return;
    for (uint32_t i = 0; i < job->nodes; i++)
        job->root[i] = i;
    for (uint32_t i = 0; i < job->leaves; i++)
        for (uint32_t t = 0; t < job->leaf[i].touches; t++) {
            const pir_rigid_touch *touch = &job->leaf[i].touch[t];
            for (uint32_t l = 0; l < touch->links; l++) {
                const uint32_t a = pir_rigid_root(job->root, job->leaf[i].node + touch->link[l][0]);
                job->root[a] = pir_rigid_root(job->root, job->leaf[touch->other].node + touch->link[l][1]);
            }
        }
}

void pir_rigid_boxes_finish(pir_rigid_job *job) {
    for (uint32_t i = 0; i < job->leaves; i++) {
        free_links(&job->leaf[i]);
        pir_box_parts_finish(&job->leaf[i].inner);
        pir_box_parts_finish(&job->leaf[i].middle);
        pir_inner_list_finish(&job->leaf[i].list);
        free_asks(&job->leaf[i]);
        free(job->leaf[i].hub);
    }
    free(job->leaf);
    free(job->list);
    free(job->root);
}
