/* SPDX-License-Identifier: MIT */
/* The header of a PLY file: which elements follow it, how many of each, and of which properties each consists. */
#ifndef PIR_POLYTOPE_READ_PLY_HEADER_H
#define PIR_POLYTOPE_READ_PLY_HEADER_H

#include "polytope/read/text.h"

/* Limits of a header, far above those of files in use. */
#define PLY_ELEMENTS_MAX   32
#define PLY_PROPERTIES_MAX 256

enum ply_format { PLY_ASCII, PLY_LITTLE, PLY_BIG };
enum ply_type { PLY_INT8, PLY_UINT8, PLY_INT16, PLY_UINT16, PLY_INT32, PLY_UINT32, PLY_FLOAT, PLY_DOUBLE };

/* The role of a property in the model. */
enum ply_role { PLY_PASSED_OVER, PLY_X, PLY_Y, PLY_Z, PLY_CORNERS };

struct ply_property {
    bool is_list;
    enum ply_type count_type; /* of a list */
    enum ply_type type;
    enum ply_role role;
    char name[PIR_SHOWN];
};

struct ply_element {
    char name[PIR_SHOWN];
    uint64_t count;
    size_t line;
    unsigned first, end; /* its properties */
};

struct ply_header {
    enum ply_format format;
    unsigned element_count, property_count;
    struct ply_element element[PLY_ELEMENTS_MAX];
    struct ply_property property[PLY_PROPERTIES_MAX];
    const struct ply_element *vertex; /* that of the points */
};

/* Bytes of a number of this type in a binary file. */
size_t pir_ply_type_size(enum ply_type type);

/* Reads up to and with the end of the header's last line, so that text->at is the first byte of the elements. */
pir_status pir_ply_read_header(struct pir_text *text, struct ply_header *ret_header);

#endif
