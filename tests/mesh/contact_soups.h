/* SPDX-License-Identifier: MIT */
/* Small soups of triangles on which ghosts and true contacts are next to each other, and bodies to put on them. */
#ifndef PIR_TEST_CONTACT_SOUPS_H
#define PIR_TEST_CONTACT_SOUPS_H

#include <pirouette/trimesh_contact.h>

#include "support/random.h"

#define SOUP_MOST   24
#define SOUP_BODIES 7

typedef struct contact_soup {
    const char *name;
    pir_vec3 corner[SOUP_MOST][3];
    uint32_t count;
    bool split; /* every second triangle is a surface of its own kind, at a pose of its own */
} contact_soup;

/* One of the kinds, told by the number; coordinates are small multiples of 1/4. */
contact_soup soup_make(test_random *random, uint64_t number);

/* Moves every height, or every coordinate, by up to 2^-10 down to an ulp, or leaves all. */
void soup_jitter(test_random *random, contact_soup *soup);

/* Vertices of a body, at most 8; how many. */
uint32_t soup_body(uint64_t number, pir_vec3 vertex[8]);

/* A rotation: none, by whole numbers, or any. */
pir_quat soup_rotation(test_random *random);

#endif
