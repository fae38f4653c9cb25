/* SPDX-License-Identifier: MIT */
/*
 * Memory that queries are about to read, asked for ahead.
 *
 * A scene asks thousands of pairs, one after the other. What each reads, the pair, both bodies and the features of the
 * last answer, is spread over more memory than caches hold, and each place is known only from the one before. So all
 * pairs of a run take the first step of that way, then all take the second, and so on: reads wait for memory together.
 * Nothing is changed, and no answer depends on it.
 */
#ifndef PIR_PAIR_FETCH_H
#define PIR_PAIR_FETCH_H

#include <pirouette/pair.h>

/* The most pairs of one run: what they read fits into the nearest caches. */
#define PIR_FETCH_MOST 16

/* Asks for what the next queries of these pairs read first. */
void pir_pair_fetch(pir_pair *const *pairs, uint32_t count);

#endif
