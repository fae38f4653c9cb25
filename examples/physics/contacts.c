/* SPDX-License-Identifier: MIT */
/*
 * Events and links are in one order, so one walk along both finds what stays. An event is missing for a link where no
 * body of it was moved: then both sleep, or the scene would have told.
 */
#include "contacts.h"

#include <stdlib.h>
#include <string.h>

/* Room for so many more in an array; false where memory runs out. */
static bool reserve(void **at, uint32_t *room, size_t need, size_t size) {
    if (need <= *room)
        return true;
    if (need > UINT32_MAX / 2)
        return false;
    uint32_t more = (uint32_t)(need + need / 2 + 16);
    void *grown = realloc(*at, more * size);
    if (grown) {
        *at = grown;
        *room = more;
    }
    return grown;
}

static struct link *add(struct contacts *to, const struct link *as, uint32_t points) {
    void *link = to->link, *point = to->point;
    bool done = reserve(&link, &to->link_room, to->link_count + (size_t)1, sizeof *to->link);
    to->link = link;
    done = done && reserve(&point, &to->point_room, to->point_count + (size_t)points, sizeof *to->point);
    to->point = point;
    if (!done)
        return NULL;
    struct link *made = &to->link[to->link_count++];
    *made = *as;
    made->first = to->point_count;
    made->count = points;
    to->point_count += points;
    return made;
}

/* The order of a link and an event. */
static int compare(const struct link *a, const pir_scene_event *b) {
    const uint32_t of_a[4] = {a->body_p, a->body_q, a->piece_p, a->piece_q};
    const uint32_t of_b[4] = {b->body_p, b->body_q, b->piece_p, b->piece_q};
    for (int i = 0; i < 4; i++)
        if (of_a[i] != of_b[i])
            return of_a[i] < of_b[i] ? -1 : 1;
    return 0;
}

/* Unit vectors across the normal. */
static void set_across(struct link *link) {
    pir_vec3 n = link->normal;
    pir_vec3 off = fabs(n.x) < 0.6 ? (pir_vec3){1, 0, 0} : (pir_vec3){0, 1, 0}, a = vec_cross(n, off);
    link->across[0] = vec_times(1 / vec_length(a), a);
    link->across[1] = vec_cross(n, link->across[0]);
}

/* The impulses of the point of the same id. */
static void warm(struct point *point, const struct link *link, const struct contacts *last, const struct link *before) {
    for (uint32_t k = before->first; k < before->first + before->count; k++) {
        const struct point *old = &last->point[k];
        if (old->id != point->id)
            continue;
        point->impulse = point->spent = old->impulse;
        point->rub = vec_less(old->rub, vec_times(vec_dot(old->rub, link->normal), link->normal));
        return;
    }
}

/* A link from an event, with what `before` knows, if it is not NULL. */
static bool take(struct contacts *next, const struct contacts *last, const struct link *before, const struct body *body,
                 const pir_scene_event *event) {
    struct link as = {event->body_p, event->body_q, event->piece_p, event->piece_q, .normal = event->normal};
    set_across(&as);
    struct link *link = add(next, &as, event->contact_count);
    if (!link)
        return false;
    for (uint32_t i = 0; i < event->contact_count; i++) {
        const pir_contact *contact = &event->contacts[i];
        struct point *point = &next->point[link->first + i];
        pir_vec3 middle = vec_times(0.5, vec_add(contact->point_p, contact->point_q));
        *point = (struct point){.id = contact->id, .distance = contact->distance};
        point->at_p = vec_less(middle, body[link->body_p].pose.translation);
        point->at_q = vec_less(middle, body[link->body_q].pose.translation);
        if (before)
            warm(point, link, last, before);
    }
    return true;
}

static bool keep(struct contacts *next, const struct contacts *last, const struct link *before) {
    struct link *link = add(next, before, before->count);
    if (link)
        memcpy(&next->point[link->first], &last->point[before->first], before->count * sizeof *next->point);
    return link;
}

bool contacts_follow(struct contacts *next, const struct contacts *last, const struct body *body,
                     const pir_scene_event *event, size_t count) {
    next->link_count = next->point_count = 0;
    bool done = true;
    uint32_t l = 0;
    for (size_t e = 0; done && (e < count || l < last->link_count);) {
        const struct link *before = l < last->link_count ? &last->link[l] : NULL;
        int order = !before ? 1 : e == count ? -1 : compare(before, &event[e]);
        if (order < 0)
            done = keep(next, last, before);
        else if (event[e].kind != PIR_EVENT_ENDED && event[e].contact_count > 0)
            done = take(next, last, order == 0 ? before : NULL, body, &event[e]);
        l += order <= 0;
        e += order >= 0;
    }
    return done;
}

bool contacts_copy(struct contacts *to, const struct contacts *from) {
    void *link = to->link, *point = to->point;
    bool done = reserve(&link, &to->link_room, from->link_count, sizeof *to->link);
    to->link = link;
    done = done && reserve(&point, &to->point_room, from->point_count, sizeof *to->point);
    to->point = point;
    if (!done)
        return false;
    to->link_count = from->link_count;
    to->point_count = from->point_count;
    if (from->link_count > 0)
        memcpy(to->link, from->link, from->link_count * sizeof *to->link);
    if (from->point_count > 0)
        memcpy(to->point, from->point, from->point_count * sizeof *to->point);
    return true;
}

void contacts_clear(struct contacts *contacts) {
    free(contacts->link);
    free(contacts->point);
    *contacts = (struct contacts){0};
}
