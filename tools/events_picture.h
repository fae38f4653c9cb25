/* SPDX-License-Identifier: MIT */
/* A chart, in SVG, of how many facets a sum has over the angle of a turn. */
#ifndef TOOLS_EVENTS_PICTURE_H
#define TOOLS_EVENTS_PICTURE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* An event: where it is, and how many facets there are from there on. */
struct chart_event {
    double degrees;
    uint32_t facets;
};

struct events_chart {
    const char *title[2]; /* of P and Q */
    double from, to;      /* degrees, from < to */
    uint32_t facets;      /* before the first event */
    const struct chart_event *event;
    size_t count;
};

void events_picture_write(FILE *file, const struct events_chart *chart);

#endif
