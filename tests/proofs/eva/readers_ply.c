/* SPDX-License-Identifier: MIT */
/*
 * What Eva analyses: the elements of a PLY file, of any bytes, after a header of three elements, of any properties that
 * ply_header.h allows. The header's own lines are readers_header.c's.
 */
#define MOST 60

#include "polytope/read/ply_header.h"
#include "readers_files.h"

/* A property; the sizes of lists and the corners are integers. */
static struct ply_property any_property(enum ply_role role) {
    struct ply_property property = {.role = role, .name = "p"};
    property.is_list = role == PLY_CORNERS || (role == PLY_PASSED_OVER && Frama_C_interval(0, 1));
    property.count_type = (enum ply_type)Frama_C_interval(PLY_INT8, PLY_UINT32);
    property.type = (enum ply_type)Frama_C_interval(PLY_INT8, role == PLY_CORNERS ? PLY_UINT32 : PLY_DOUBLE);
    return property;
}

static struct ply_element any_element(unsigned first, unsigned end) {
    return (struct ply_element){"element", Frama_C_unsigned_int_interval(0, UINT32_MAX), 1, first, end};
}

size_t pir_ply_type_size(enum ply_type type) {
    static const size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[type];
}

pir_status pir_ply_read_header(struct pir_text *text, struct ply_header *ret_header) {
    static const enum ply_role roles[] = {PLY_PASSED_OVER, PLY_X, PLY_Y, PLY_Z, PLY_PASSED_OVER, PLY_CORNERS};
    *ret_header = (struct ply_header){
        .format = (enum ply_format)Frama_C_interval(PLY_ASCII, PLY_BIG), .element_count = 3, .property_count = 6};
    //@ loop unroll 6;
    for (int i = 0; i < 6; i++)
        ret_header->property[i] = any_property(roles[i]);
    ret_header->element[0] = any_element(0, 1);
    ret_header->element[1] = any_element(1, 5);
    ret_header->element[2] = any_element(5, 6);
    ret_header->vertex = &ret_header->element[1];
    text->at = (size_t)Frama_C_unsigned_int_interval(0, (unsigned int)text->size);
    return Frama_C_interval(0, 1) ? PIR_OK : PIR_ERR_FORMAT;
}

int main(void) {
    return (int)ask(pir_read_ply, "", 0, MOST);
}
