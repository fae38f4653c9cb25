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

/* Has a first leaf and one of another orbit touch where they do. */
static void touch_both(pir_rigid_job *job, uint32_t first, uint32_t other) {
    if (pir_rotation_boxes_touch(job->leaf[first].box, job->leaf[other].box)) {
        add_touch(job, first, other);
        add_touch(job, pir_rigid_first(job, other), first ^ pir_rigid_image(job, other));
    }
}

/* Likewise for all orbits from one on, and within each. */
static void touch_new(pir_rigid_job *job, uint32_t first) {
    const uint32_t size = job->question->symmetries.count;
    for (uint32_t i = first; i < job->leaves && job->status == PIR_OK; i += size) {
        for (uint32_t k = first; k < i; k++)
            touch_both(job, i, k);
        for (uint32_t e = 1; e < size; e++)
            if (pir_rotation_boxes_touch(job->leaf[i].box, job->leaf[i ^ e].box))
                add_touch(job, i, i ^ e);
    }
}

/* Adds an orbit, of a box whose parent is told; its first, or none. */
static uint32_t add_orbit(pir_rigid_job *job, pir_rotation_box box, uint32_t parent) {
    const pir_symmetries *s = &job->question->symmetries;
    const uint32_t first = job->leaves;
    if (!pir_rigid_grow(job, (void **)&job->leaf, &job->leaf_room, first + s->count, sizeof *job->leaf))
        return PIR_PLAN_NONE;
    for (uint32_t e = 0; e < s->count; e++)
        job->leaf[job->leaves++] = (pir_rigid_leaf){.box = pir_symmetries_image(s, e, box),
                                                    .parent = parent == PIR_PLAN_NONE ? parent : parent ^ e};
    job->alive += s->count;
    return first;
}

static bool has_box(const pir_rigid_job *job, pir_rotation_box box) {
    for (uint32_t i = 0; i < job->leaves; i++)
        if (job->leaf[i].box.chart == box.chart && memcmp(job->leaf[i].box.at, box.at, sizeof box.at) == 0)
            return true;
    return false;
}

void pir_rigid_boxes_begin(pir_rigid_job *job) {
    for (uint32_t i = 0; i < PIR_ROTATION_ROOTS && job->status == PIR_OK; i++)
        if (!has_box(job, pir_rotation_box_root(i)))
            add_orbit(job, pir_rotation_box_root(i), PIR_PLAN_NONE);
    touch_new(job, 0);
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

/* Has the orbits from one on stand for another, whose boxes they are parts of. */
static void replace(pir_rigid_job *job, uint32_t leaf, uint32_t first) {
    const uint32_t size = job->question->symmetries.count;
    for (uint32_t t = 0; t < job->leaf[leaf].touches && job->status == PIR_OK; t++) {
        const uint32_t other = job->leaf[leaf].touch[t].other, of_other = pir_rigid_first(job, other);
        if (of_other == leaf)
            continue;
        drop_touch(&job->leaf[of_other], leaf ^ pir_rigid_image(job, other));
        for (uint32_t i = first; i < job->leaves && job->status == PIR_OK; i += size)
            touch_both(job, i, other);
    }
    touch_new(job, first);
    pir_rigid_leaf *old = &job->leaf[leaf];
    free_links(old);
    job->kept -= pir_box_parts_size(&old->inner) + pir_inner_list_size(&old->list);
    pir_box_parts_finish(&old->inner);
    pir_inner_list_finish(&old->list);
    free_asks(old);
    for (uint32_t e = 0; e < size; e++)
        job->leaf[leaf ^ e].is_divided = true;
    job->alive -= size;
}

void pir_rigid_box_divide(pir_rigid_job *job, uint32_t leaf) {
    const uint32_t first = job->leaves, old = pir_rigid_first(job, leaf);
    const pir_rotation_box box = job->leaf[old].box;
    for (uint32_t i = 0; i < 8; i++)
        add_orbit(job, pir_rotation_box_child(box, i), old);
    replace(job, old, first);
}

/* Has a leaf stand in the place of another, of the same box. */
static void take_place(pir_rigid_leaf *own, pir_rigid_leaf *old) {
    own->parent = old->parent;
    own->is_full = old->is_full;
    own->middle = old->middle;
    own->hub = old->hub;
    own->hubs = old->hubs;
    own->hub_room = old->hub_room;
    old->middle = (pir_box_parts){0};
    old->hub = NULL;
    old->hubs = old->hub_room = 0;
    old->is_full = false;
}

void pir_rigid_box_refine(pir_rigid_job *job, uint32_t leaf) {
    const uint32_t old = pir_rigid_first(job, leaf), made = add_orbit(job, job->leaf[old].box, PIR_PLAN_NONE);
    if (made == PIR_PLAN_NONE)
        return;
    pir_rigid_leaf *own = &job->leaf[made], *from = &job->leaf[old];
    if (!pir_inner_list_copy(&from->list, &own->list))
        job->status = PIR_ERR_MEMORY;
    own->list.rounds++;
    own->shared = from->shared;
    own->shareds = from->shareds;
    from->shared = NULL;
    for (uint32_t e = 0; e < job->question->symmetries.count; e++)
        take_place(&job->leaf[made ^ e], &job->leaf[old ^ e]);
    replace(job, old, made);
}

bool pir_rigid_box_may_refine(const pir_rigid_job *job, uint32_t leaf) {
    const pir_rigid_leaf *first = &job->leaf[pir_rigid_first(job, leaf)];
    return !job->leaf[leaf].is_open && !first->is_spent && first->list.rounds < MOST_ROUNDS;
}

/* --- parts --- */

/* Notes which parts have the translations of the ends, about: a box is open where one has both, or none has one. */
static void note_ends(pir_rigid_job *job, uint32_t leaf) {
    const pir_box_parts *parts = &job->leaf[pir_rigid_first(job, leaf)].inner;
    uint32_t *end = job->leaf[leaf].end;
    end[0] = end[1] = PIR_PLAN_NONE;
    for (int s = 0; s < 2; s++) {
        double at[3];
        pir_symmetries_place(&job->question->symmetries, pir_rigid_image(job, leaf), job->question->at[s], at);
        for (uint32_t i = 0; i < parts->cells; i++)
            if (pir_box_cell_has(parts, &parts->cell[i], at))
                end[s] = parts->cell[i].part;
    }
    job->leaf[leaf].is_open = end[0] == end[1] || end[0] == PIR_PLAN_NONE || end[1] == PIR_PLAN_NONE;
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
    return &job->leaf[job->first_new + index * job->question->symmetries.count];
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

/* Tells how many boxes are made: those that are divided count until as many stand for them. */
static bool tell_made(pir_rigid_job *job, uint32_t made) {
    const pir_rigid_question *q = job->question;
    job->told = made > job->told ? made : job->told;
    return !q->progress || q->progress(q->context, job->told, 0);
}

static bool tell_leaves(void *data, uint32_t done) {
    pir_rigid_job *job = data;
    return tell_made(job, job->alive + done * job->question->symmetries.count - (job->leaves - job->first_new));
}

static bool tell_middles(void *data, uint32_t done) {
    (void)done;
    return tell_made(data, 0);
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
    pir_rigid_leaf *leaf = new_leaf(data, index);
    leaf->status = status;
    const bool good = status != PIR_OK || unpack_leaf(data, block, leaf);
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
    leaf->status = status == PIR_ERR_LIMIT || status == PIR_PLAN_ERR_PARTS ? PIR_OK : status;
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

/* Links the first of an orbit with another leaf, whose parts are made where it is no first one. */
static pir_status link_with(const pir_rigid_job *job, const pir_rigid_leaf *leaf, pir_rigid_touch *touch) {
    const uint32_t image = pir_rigid_image(job, touch->other);
    const pir_box_parts *of_other = &job->leaf[pir_rigid_first(job, touch->other)].inner;
    pir_box_parts turned;
    if (image == 0)
        return link_two(&leaf->inner, of_other, touch);
    pir_status status = pir_box_parts_image(of_other, &job->question->symmetries, image, &turned);
    if (status == PIR_OK)
        status = link_two(&leaf->inner, &turned, touch);
    pir_box_parts_finish(&turned);
    return status;
}

static void link_leaf(void *data, uint32_t index) {
    pir_rigid_job *job = data;
    pir_rigid_leaf *leaf = new_leaf(data, index);
    const uint32_t own = (uint32_t)(leaf - job->leaf);
    for (uint32_t e = 0; e < job->question->symmetries.count; e++)
        note_ends(job, own ^ e);
    for (uint32_t i = 0; i < leaf->touches && leaf->status == PIR_OK; i++) {
        pir_rigid_touch *touch = &leaf->touch[i];
        if (pir_rigid_first(job, touch->other) <= own && !touch->is_linked)
            leaf->status = link_with(job, leaf, touch);
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
    for (uint32_t i = 0; i < leaf->asks && leaf->status == PIR_OK; i++) {
        const uint32_t other = leaf->ask[i].other, image = pir_rigid_image(job, other);
        const pir_box_parts *of_other = &job->leaf[pir_rigid_first(job, other)].inner;
        pir_box_parts turned = {0};
        if (image != 0)
            leaf->status = pir_box_parts_image(of_other, &job->question->symmetries, image, &turned);
        if (leaf->status == PIR_OK)
            list_shared(leaf, &leaf->ask[i], image == 0 ? of_other : &turned);
        if (image != 0)
            pir_box_parts_finish(&turned);
    }
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
    for (uint32_t i = 0; i < job->listed && job->status == PIR_OK; i++)
        job->status = job->leaf[job->list[i]].status;
}

/* Counts what a division left. */
static void count_parts(pir_rigid_job *job, const pir_box_parts *parts) {
    job->parts += parts->nodes;
    job->kept += pir_box_parts_size(parts);
    if (job->kept > job->question->memory && job->status == PIR_OK)
        job->status = PIR_ERR_LIMIT;
}

void pir_rigid_boxes_make(pir_rigid_job *job) {
    const uint32_t size = job->question->symmetries.count, count = (job->leaves - job->first_new) / size;
    const pir_tasks tasks = job->makers->tasks;
    const pir_block_work work = {job, count, leaf_number, make_leaf, pack_leaf, take_leaf, tell_leaves};
    job->status = pir_rigid_told(pir_blocks_make(job->makers, &work));
    for (uint32_t i = job->first_new; i < job->leaves && job->status == PIR_OK; i += size) {
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

/* Divides the translations at the middles of first leaves that the job lists. */
static void make_middles(pir_rigid_job *job) {
    const pir_block_work work = {job, job->listed, middle_number, fill_leaf, pack_middle, take_middle, tell_middles};
    job->status = pir_rigid_told(pir_blocks_make(job->makers, &work));
    for (uint32_t i = 0; i < job->listed && job->status == PIR_OK; i++) {
        job->status = job->leaf[job->list[i]].status;
        count_parts(job, &job->leaf[job->list[i]].middle);
    }
}

/* Images of free parts are as good as the pieces are symmetric; paths do not rest on them, but are proven anew. */
void pir_rigid_boxes_fill(pir_rigid_job *job) {
    uint32_t *first = calloc((size_t)job->listed + 1, sizeof *first), *all = job->list;
    const uint32_t listed = job->listed;
    if (!first) {
        job->status = PIR_ERR_MEMORY;
        return;
    }
    job->listed = 0;
    for (uint32_t i = 0; i < listed; i++) {
        const uint32_t own = pir_rigid_first(job, all[i]);
        if (!job->leaf[own].middle.x && (job->listed == 0 || first[job->listed - 1] != own))
            first[job->listed++] = own;
    }
    job->list = first;
    make_middles(job);
    job->list = all;
    job->listed = listed;
    for (uint32_t i = 0; i < listed && job->status == PIR_OK; i++) {
        pir_rigid_leaf *leaf = &job->leaf[all[i]];
        const pir_rigid_leaf *own = &job->leaf[pir_rigid_first(job, all[i])];
        leaf->is_full = own->middle.x;
        if (!leaf->is_full || leaf == own)
            continue;
        job->status =
            pir_box_parts_image(&own->middle, &job->question->symmetries, pir_rigid_image(job, all[i]), &leaf->middle);
        count_parts(job, &leaf->middle);
    }
    free(first);
}

void pir_rigid_boxes_join(pir_rigid_job *job) {
    job->nodes = 0;
    for (uint32_t i = 0; i < job->leaves; i++)
        if (!job->leaf[i].is_divided) {
            job->leaf[i].node = job->nodes;
            job->nodes += job->leaf[pir_rigid_first(job, i)].inner.parts;
        }
    if (!pir_rigid_grow(job, (void **)&job->root, &job->root_room, job->nodes, sizeof *job->root))
        return;
    for (uint32_t i = 0; i < job->nodes; i++)
        job->root[i] = i;
    for (uint32_t i = 0; i < job->leaves; i++)
        for (uint32_t t = 0; t < job->leaf[pir_rigid_first(job, i)].touches; t++) {
            const pir_rigid_touch *touch = &job->leaf[pir_rigid_first(job, i)].touch[t];
            const pir_rigid_leaf *other = &job->leaf[touch->other ^ pir_rigid_image(job, i)];
            for (uint32_t l = 0; l < touch->links; l++) {
                const uint32_t a = pir_rigid_root(job->root, job->leaf[i].node + touch->link[l][0]);
                job->root[a] = pir_rigid_root(job->root, other->node + touch->link[l][1]);
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
