/* SPDX-License-Identifier: MIT */
/* See rigid_plan.h. */
#include "plan/rigid/rigid_search.h"

#include <stdlib.h>
#include <string.h>

#include "plan/opening/opening.h"
#include "plan/rigid/rigid_boxes.h"
#include "plan/rigid/rigid_hubs.h"
#include "plan/rigid/rigid_path.h"
#include "plan/rigid/rigid_write.h"

/* A search over nodes: how far each is from those that are at the start, and at the end. */
struct doubt {
    uint32_t *first, *next; /* per node, where its links begin in the list of the linked */
    uint32_t *leaf;         /* of each node */
    uint32_t *far[2], *queue;
};

static bool open_doubt(const pir_rigid_job *job, struct doubt *d) {
    size_t links = 0;
    for (uint32_t i = 0; i < job->leaves; i++)
        for (uint32_t t = 0; t < job->leaf[i].touches; t++)
            links += (size_t)job->leaf[i].touch[t].links * job->question->symmetries.count;
    d->first = calloc((size_t)job->nodes + 2, sizeof *d->first);
    d->next = calloc(2 * links + 1, sizeof *d->next);
    d->leaf = calloc((size_t)job->nodes + 1, sizeof *d->leaf);
    d->queue = calloc((size_t)job->nodes + 1, sizeof *d->queue);
    for (int s = 0; s < 2; s++)
        d->far[s] = calloc((size_t)job->nodes + 1, sizeof *d->far[s]);
    return d->first && d->next && d->leaf && d->queue && d->far[0] && d->far[1];
}

static void close_doubt(struct doubt *d) {
    free(d->first);
    free(d->next);
    free(d->leaf);
    free(d->queue);
    free(d->far[0]);
    free(d->far[1]);
}

/* Calls for both nodes of each link: counts where `list` is false, else lists. */
static void each_link(const pir_rigid_job *job, struct doubt *d, bool list) {
    for (uint32_t i = 0; i < job->leaves; i++)
        for (uint32_t t = 0; t < job->leaf[pir_rigid_first(job, i)].touches; t++) {
            const pir_rigid_touch *touch = &job->leaf[pir_rigid_first(job, i)].touch[t];
            const pir_rigid_leaf *other = &job->leaf[touch->other ^ pir_rigid_image(job, i)];
            for (uint32_t l = 0; l < touch->links; l++) {
                const uint32_t a = job->leaf[i].node + touch->link[l][0], b = other->node + touch->link[l][1];
                if (list) {
                    d->next[d->first[a + 1]++] = b;
                    d->next[d->first[b + 1]++] = a;
                } else {
                    d->first[a + 2]++;
                    d->first[b + 2]++;
                }
            }
        }
}

static void list_links(const pir_rigid_job *job, struct doubt *d) {
    each_link(job, d, false);
    for (uint32_t n = 2; n < job->nodes + 2; n++)
        d->first[n] += d->first[n - 1];
    each_link(job, d, true);
    for (uint32_t i = 0; i < job->leaves; i++)
        for (uint32_t p = 0; !job->leaf[i].is_divided && p < job->leaf[pir_rigid_first(job, i)].inner.parts; p++)
            d->leaf[job->leaf[i].node + p] = i;
}

static void add_source(struct doubt *d, int side, uint32_t node, uint32_t *count) {
    if (d->far[side][node] != 0) {
        d->far[side][node] = 0;
        d->queue[(*count)++] = node;
    }
}

/* The nodes that an end is in. */
static uint32_t list_ends(const pir_rigid_job *job, int side, uint32_t *node, uint32_t room) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->leaves; i++) {
        const pir_rigid_leaf *leaf = &job->leaf[i];
        const pir_box_parts *inner = &job->leaf[pir_rigid_first(job, i)].inner;
        double at[3];
        if (leaf->is_divided || !pir_rotation_box_has(leaf->box, job->question->rotation[side]))
            continue;
        pir_symmetries_place(&job->question->symmetries, pir_rigid_image(job, i), job->question->at[side], at);
        for (uint32_t k = 0; k < inner->cells && count < room; k++)
            if (pir_box_cell_has(inner, &inner->cell[k], at))
                node[count++] = leaf->node + inner->cell[k].part;
    }
    return count;
}

#define MOST_ENDS 1024

/* How far nodes are from those that an end is in, or a hub that the end reaches, or that have the end's translation
 * in a box that parts both ends: such nodes of either end are to be parted in any case. */
static void measure(pir_rigid_job *job, struct doubt *d, int side) {
    uint32_t count = 0, end[MOST_ENDS];
    const uint32_t ends = list_ends(job, side, end, MOST_ENDS), root = pir_rigid_root(job->hub_root, (uint32_t)side);
    memset(d->far[side], 0xff, job->nodes * sizeof *d->far[side]);
    for (uint32_t i = 0; i < ends; i++)
        add_source(d, side, end[i], &count);
    for (uint32_t i = 0; i < job->leaves; i++) {
        const pir_rigid_leaf *leaf = &job->leaf[i];
        if (!leaf->is_divided && !leaf->is_open)
            add_source(d, side, leaf->node + leaf->end[side], &count);
        for (uint32_t h = 0; !leaf->is_divided && h < leaf->hubs; h++)
            if (leaf->hub[h].in != PIR_PLAN_NONE && pir_rigid_root(job->hub_root, leaf->hub[h].node) == root)
                add_source(d, side, leaf->node + leaf->hub[h].in, &count);
    }
    for (uint32_t done = 0; done < count; done++) {
        const uint32_t node = d->queue[done];
        for (uint32_t i = d->first[node]; i < d->first[node + 1]; i++)
            if (d->far[side][d->next[i]] == PIR_PLAN_NONE) {
                d->far[side][d->next[i]] = d->far[side][node] + 1;
                d->queue[count++] = d->next[i];
            }
    }
}

/* How long shortest ways are; none is PIR_PLAN_NONE. */
static uint32_t shortest(const pir_rigid_job *job, const struct doubt *d) {
    uint32_t least = PIR_PLAN_NONE;
    for (uint32_t n = 0; n < job->nodes; n++)
        if (d->far[0][n] != PIR_PLAN_NONE && d->far[1][n] != PIR_PLAN_NONE) {
            const uint32_t far = d->far[0][n] + d->far[1][n];
            least = far < least ? far : least;
        }
    return least;
}

/* Marks boxes on shortest ways that have a way of their own: of nodes between those of the ends, where there are. */
static void mark(const pir_rigid_job *job, const struct doubt *d, uint32_t least, bool *is_divided) {
    for (uint32_t n = 0; n < job->nodes; n++) {
        const uint32_t a = d->far[0][n], b = d->far[1][n];
        if (a != PIR_PLAN_NONE && b != PIR_PLAN_NONE && a + b == least && (least < 2 || (a > 0 && b > 0)))
            is_divided[d->leaf[n]] = least == 0 || job->leaf[d->leaf[n]].is_open;
    }
}

/* The boxes of an end that no hub reaches. */
static void mark_ends(pir_rigid_job *job, bool *is_divided) {
    bool is_reached[PIR_RIGID_ENDS] = {false, false};
    for (uint32_t i = 0; i < job->turns; i++)
        for (int s = 0; s < 2; s++)
            if (job->turn[i].hub[s] < PIR_RIGID_ENDS)
                is_reached[job->turn[i].hub[s]] = true;
    for (uint32_t i = 0; i < job->leaves; i++)
        for (int s = 0; s < PIR_RIGID_ENDS; s++)
            if (!is_reached[s] && !job->leaf[i].is_divided &&
                pir_rotation_box_has(job->leaf[i].box, job->question->rotation[s]))
                is_divided[i] = true;
}

/* Whether a link is on a shortest way. */
static bool is_on_way(const struct doubt *d, uint32_t a, uint32_t b, uint32_t least) {
    for (int s = 0; s < 2; s++)
        if (d->far[s][a] != PIR_PLAN_NONE && d->far[1 - s][b] != PIR_PLAN_NONE &&
            d->far[s][a] + 1 + d->far[1 - s][b] == least)
            return true;
    return false;
}

/* How often the boxes of the orbit of a leaf are asked. */
static uint32_t asks_of(const pir_rigid_job *job, uint32_t leaf) {
    return job->leaf[pir_rigid_first(job, leaf)].asks;
}

/* Asks the first of the orbit of a leaf, in its own translations, where it is not asked for that yet. */
static bool ask(pir_rigid_job *job, uint32_t leaf, pir_rigid_ask what) {
    pir_rigid_leaf *own = &job->leaf[pir_rigid_first(job, leaf)];
    what.other ^= pir_rigid_image(job, leaf);
    for (uint32_t i = 0; i < own->asks; i++)
        if (own->ask[i].part == what.part && own->ask[i].other == what.other &&
            own->ask[i].other_part == what.other_part)
            return true;
    if (pir_rigid_grow(job, (void **)&own->ask, &own->ask_room, own->asks + 1, sizeof *own->ask))
        own->ask[own->asks++] = what;
    return job->status == PIR_OK;
}

/*
 * Asks the boxes of a link to block what both parts share: one of them where neither was asked before, the one of more
 * such links, which then blocks what many others leave; else both that may. Boxes that are to be divided are marked:
 * of a link that neither may block, the larger one.
 */
static void ask_link(pir_rigid_job *job, const uint32_t leaf[2], const uint32_t part[2], const uint32_t *links,
                     bool *is_divided) {
    const uint32_t first[2] = {pir_rigid_first(job, leaf[0]), pir_rigid_first(job, leaf[1])};
    const pir_rigid_leaf *of[2] = {&job->leaf[first[0]], &job->leaf[first[1]]};
    bool may[2] = {pir_rigid_box_may_refine(job, leaf[0]), pir_rigid_box_may_refine(job, leaf[1])};
    if (may[0] && may[1] && of[0]->list.rounds == 0 && of[1]->list.rounds == 0)
        may[links[first[0]] < links[first[1]]] = false;
    for (int s = 0; s < 2; s++) {
        if (may[s])
            ask(job, leaf[s], (pir_rigid_ask){part[s], leaf[1 - s], part[1 - s]});
        if (!may[0] && !may[1] && of[s]->box.level <= of[1 - s]->box.level)
            is_divided[leaf[s]] = true;
    }
}

/* Calls for the links on shortest ways: counts those of each box, or asks. */
static void each_doubted(pir_rigid_job *job, const struct doubt *d, uint32_t least, uint32_t *links, bool *is_divided) {
    for (uint32_t i = 0; i < job->leaves; i++)
        for (uint32_t t = 0; t < job->leaf[pir_rigid_first(job, i)].touches; t++) {
            const pir_rigid_touch *touch = &job->leaf[pir_rigid_first(job, i)].touch[t];
            for (uint32_t l = 0; l < touch->links; l++) {
                const uint32_t leaf[2] = {i, touch->other ^ pir_rigid_image(job, i)},
                               part[2] = {touch->link[l][0], touch->link[l][1]};
                if (!is_on_way(d, job->leaf[i].node + part[0], job->leaf[leaf[1]].node + part[1], least))
                    continue;
                links[pir_rigid_first(job, leaf[0])] += !is_divided;
                links[pir_rigid_first(job, leaf[1])] += !is_divided;
                if (is_divided)
                    ask_link(job, leaf, part, links, is_divided);
            }
        }
}

/* Asks boxes to block links on shortest ways, and marks those that are to be divided instead. */
static void ask_all(pir_rigid_job *job, const struct doubt *d, uint32_t least, bool *is_divided) {
    uint32_t *links = calloc((size_t)job->leaves + 1, sizeof *links);
    if (links && least != PIR_PLAN_NONE) {
        each_doubted(job, d, least, links, NULL);
        each_doubted(job, d, least, links, is_divided);
    }
    job->status = links ? job->status : PIR_ERR_MEMORY;
    free(links);
}

/* Lists the boxes that are doubted: those that are asked, and those that are to be divided and can be. */
static void list_doubted(pir_rigid_job *job) {
    struct doubt d = {0};
    bool *is_divided = calloc(job->leaves, sizeof *is_divided);
    if (is_divided && open_doubt(job, &d)) {
        list_links(job, &d);
        measure(job, &d, 0);
        measure(job, &d, 1);
        const uint32_t least = shortest(job, &d);
        mark(job, &d, least, is_divided);
        ask_all(job, &d, least, is_divided);
        mark_ends(job, is_divided);
    } else {
        job->status = PIR_ERR_MEMORY;
    }
    close_doubt(&d);
    job->listed = 0;
    // in the beginning all middles are looked at, and nothing tells which boxes are nearest
    const bool is_first = job->leaves == PIR_ROTATION_ROOTS;
    for (uint32_t i = 0; i < job->leaves && job->status == PIR_OK; i++) {
        pir_rigid_leaf *leaf = &job->leaf[i];
        leaf->is_due = (is_divided[i] || (is_first && leaf->is_open)) && asks_of(job, i) == 0 &&
                       leaf->box.level < PIR_ROTATION_LEVELS;
        if ((leaf->asks > 0 || leaf->is_due || is_first) &&
            pir_rigid_grow(job, (void **)&job->list, &job->list_room, job->listed + 1, sizeof *job->list))
            job->list[job->listed++] = i;
    }
    free(is_divided);
}

/* Divides listed boxes as far as the budget goes, or has them block what they are asked; how many. */
static uint32_t divide(pir_rigid_job *job) {
    uint32_t count = 0;
    pir_rigid_boxes_ask(job);
    job->end = PIR_PLAN_END_FINEST;
    job->first_new = job->leaves;
    for (uint32_t i = 0; i < job->listed && job->status == PIR_OK; i++)
        if (job->leaf[job->list[i]].is_divided) {
            continue; // with another of its orbit
        } else if (asks_of(job, job->list[i]) > 0) {
            pir_rigid_box_refine(job, job->list[i]);
            count++;
        } else if (job->leaf[job->list[i]].is_due) {
            if (job->alive + 7 * job->question->symmetries.count > job->question->most_boxes) {
                job->end = PIR_PLAN_END_BOXES;
                continue;
            }
            pir_rigid_box_divide(job, job->list[i]);
            count++;
        }
    return count;
}

/* Keeps of the list those boxes whose middles are to be known, and are not yet. */
static uint32_t keep_unknown(pir_rigid_job *job, uint32_t *kept) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->listed; i++) {
        const pir_rigid_leaf *leaf = &job->leaf[job->list[i]];
        if (!leaf->is_full && asks_of(job, job->list[i]) == 0)
            kept[count++] = job->list[i];
    }
    return count;
}

/* Looks at the middles of listed boxes; the list stays. */
static void look_at_middles(pir_rigid_job *job) {
    uint32_t *kept = calloc((size_t)job->listed + 1, sizeof *kept), *all = job->list;
    const uint32_t listed = job->listed;
    if (!kept) {
        job->status = PIR_ERR_MEMORY;
        return;
    }
    job->listed = keep_unknown(job, kept);
    job->list = kept;
    pir_rigid_boxes_fill(job);
    if (job->status == PIR_OK)
        pir_rigid_hubs_join(job);
    job->list = all;
    job->listed = listed;
    free(kept);
}

/* Whether inner sums leave no way between the ends. */
static bool is_cut(pir_rigid_job *job, uint32_t *ret_root) {
    uint32_t end[2][MOST_ENDS], ends[2];
    for (int s = 0; s < 2; s++)
        ends[s] = list_ends(job, s, end[s], MOST_ENDS);
    for (uint32_t i = 1; i < ends[0]; i++)
        job->root[pir_rigid_root(job->root, end[0][i])] = pir_rigid_root(job->root, end[0][0]);
    bool is_joined = ends[0] == 0 || ends[1] == 0 || ends[0] == MOST_ENDS || ends[1] == MOST_ENDS;
    if (!is_joined)
        *ret_root = pir_rigid_root(job->root, end[0][0]);
    for (uint32_t i = 0; i < ends[1] && !is_joined; i++)
        is_joined = pir_rigid_root(job->root, end[1][i]) == *ret_root;
    return !is_joined;
}

/* Looks at the new boxes; true where the question is decided, or can be decided no more. */
static bool take_round(pir_rigid_job *job, FILE *proof, pir_rigid_result *result) {
    uint32_t root = 0;
    pir_rigid_boxes_make(job);
    if (job->status == PIR_OK)
        pir_rigid_boxes_join(job);
    if (job->status == PIR_OK && is_cut(job, &root)) {
        job->status = proof ? pir_rigid_write(job, root, proof) : PIR_OK;
        if (job->status == PIR_OK)
            result->answer = PIR_TURN_PLAN_NO_PATH;
        return true;
    }
    if (job->status == PIR_OK)
        pir_rigid_hubs_inherit(job);
    if (job->status == PIR_OK)
        list_doubted(job);
    if (job->status == PIR_OK)
        look_at_middles(job);
    if (job->status == PIR_OK &&
        pir_rigid_root(job->hub_root, PIR_RIGID_START) == pir_rigid_root(job->hub_root, PIR_RIGID_GOAL)) {
        job->status = pir_rigid_path_make(job, result);
        if (result->answer != PIR_TURN_PLAN_UNKNOWN)
            return true;
    }
    return job->status != PIR_OK || divide(job) == 0;
}

/* Notes what ended a question. Statuses that are its answer are no failures. */
static pir_status note_end(pir_status status, pir_plan_end otherwise, pir_rigid_result *result) {
    result->end = status == PIR_PLAN_ERR_PARTS              ? PIR_PLAN_END_PARTS
                  : status == PIR_PLAN_ERR_CALLER           ? PIR_PLAN_END_CALLER
                  : status == PIR_ERR_LIMIT                 ? PIR_PLAN_END_MEMORY
                  : result->answer != PIR_TURN_PLAN_UNKNOWN ? PIR_PLAN_END_DECIDED
                                                            : otherwise;
    const bool is_limited = status == PIR_PLAN_ERR_PARTS || status == PIR_PLAN_ERR_CALLER || status == PIR_ERR_LIMIT;
    return is_limited ? PIR_OK : status;
}

/* --- openings --- */

/* Cells of openings are far cheaper than boxes: so many may be made where one box may be; bytes of one. */
#define CELLS_OF_BOX  64
#define BYTES_OF_CELL 160

static bool tell_opening(void *context) {
    const pir_rigid_question *q = context;
    return !q->progress || q->progress(q->context, 0, 0);
}

/* The findings of the first process, for all. */
struct opening_news {
    pir_status status;
    pir_opening_result result;
};

static pir_status share_opening(const pir_plan_ranks *ranks, struct opening_news *news) {
    void *all = NULL;
    size_t got = 0;
    if (!ranks->exchange(ranks->context, news, ranks->number > 0 ? 0 : sizeof *news, &all, &got) || got != sizeof *news)
        return PIR_ERR_MEMORY;
    memcpy(news, all, got);
    return news->status;
}

/* Looks for a wall that the robot cannot pass; of several processes the first one does. */
static pir_status try_openings(const pir_rigid_question *q, const pir_plan_ranks *ranks, FILE *proof,
                               pir_rigid_result *result) {
    const pir_plan_asked question = {q->low,   q->high,     {q->at[0], q->at[1]}, {q->rotation[0], q->rotation[1]},
                                     q->robot, q->obstacles};
    const uint64_t most = (uint64_t)q->most_boxes * CELLS_OF_BOX, room = q->memory / BYTES_OF_CELL;
    const uint64_t cells = most < room ? most : room;
    const pir_opening_budget how = {cells < UINT32_MAX / 2 ? (uint32_t)cells : UINT32_MAX / 2, tell_opening, (void *)q};
    struct opening_news news = {PIR_OK, {0}};
    if (!ranks || ranks->number == 0)
        news.status = pir_opening_decide(&question, &how, proof, &news.result);
    const pir_status status = ranks ? share_opening(ranks, &news) : news.status;
    result->cells = news.result.cells;
    if (status == PIR_OK && news.result.is_closed)
        result->answer = PIR_TURN_PLAN_NO_PATH;
    return status == PIR_ERR_LIMIT ? PIR_PLAN_ERR_CALLER : status;
}

/* Decides a question, and writes why there is no path. */
static pir_status decide(const pir_rigid_question *question, const pir_block_makers *makers, FILE *proof,
                         pir_rigid_result *ret_result) {
    pir_rigid_job job = {.question = question, .makers = makers};
    *ret_result = (pir_rigid_result){0};
    pir_status status = pir_rigid_path_push(question, makers->ranks, ret_result);
    if (status == PIR_OK && ret_result->answer == PIR_TURN_PLAN_UNKNOWN && !question->is_boxes_alone)
        status = try_openings(question, makers->ranks, proof, ret_result);
    if (status != PIR_OK || ret_result->answer != PIR_TURN_PLAN_UNKNOWN)
        return note_end(status, PIR_PLAN_END_DECIDED, ret_result);
    pir_rigid_hubs_begin(&job);
    pir_rigid_boxes_begin(&job);
    while (job.status == PIR_OK && !take_round(&job, proof, ret_result))
        continue;
    ret_result->boxes = job.alive;
    ret_result->divided = (job.alive - PIR_ROTATION_ROOTS) / 7;
    ret_result->parts = job.parts;
    pir_rigid_hubs_finish(&job);
    pir_rigid_boxes_finish(&job);
    return note_end(job.status, job.end, ret_result);
}

pir_status pir_rigid_decide(const pir_rigid_question *question, const pir_block_makers *makers, FILE *proof,
                            pir_rigid_result *ret_result) {
    const pir_status status = decide(question, makers, proof, ret_result);
    const bool is_written = status == PIR_OK && proof && ret_result->answer == PIR_TURN_PLAN_PATH;
    return is_written ? pir_rigid_write_path(question, ret_result, proof) : status;
}
