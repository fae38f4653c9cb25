/* SPDX-License-Identifier: MIT */
/* What Eva analyses: the header of a PLY file, of any 3 bytes, and of "ply" and any bytes after it. */
#define MOST 60

#include "polytope/read/ply_header.h"
#include "readers_files.h"

static struct ply_header header;

static pir_status read_header(const char *data, size_t size, struct pir_model *model) {
    struct pir_text text;
    pir_text_init(&text, data, size, model->name, NULL);
    return pir_ply_read_header(&text, &header);
}

int main(void) {
    return (int)ask(read_header, "", 0, 3) | (int)ask(read_header, "ply", 3, MOST - 3);
}
