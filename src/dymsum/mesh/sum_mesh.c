/* SPDX-License-Identifier: MIT */
/*
 * The true sum as a mesh, from a pairing.
 *
 * Beside the mesh itself, memory holds a bit for each crossing and the facets of the true sum. A sum of many ties has
 * few facets.
 */
#include "dymsum/mesh/sum_mesh.h"

#include "dymsum/mesh/facet_list.h"
#include "dymsum/mesh/pieces.h"

/* All facets of the true sum; errors as pir_facet_list_begin. */
static pir_status collect_facets(pir_facet_list *facets, const pir_pairing *pairing, const pir_posed *posed) {
    pir_sum_pieces pieces;
    pir_status status = pir_pieces_make(&pieces, pairing, posed);
    if (status != PIR_OK)
        return status;
    const pir_sum_faces faces = {posed, pieces.of_p, pieces.of_q, pairing->fv, pairing->vf};
    status = pir_facet_list_begin(facets, &pairing->allocator, &faces, pieces.alone_count);
    for (uint32_t slot = 0; status == PIR_OK && slot < pairing->crossings.used; slot++)
        if (pir_piece_is_alone(&pieces, slot))
            pir_facet_list_add_crossing(facets, posed, pairing->p->edge_half[pir_crossing_edge(pairing, slot)],
                                        pir_crossing_half(pairing, slot));
    pir_pieces_finish(&pieces, pairing);
    return status;
}

/* The mesh of the whole sum where a region leaves out a part: by a copy without one. */
static pir_status mesh_of_whole(const pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh) {
    pir_sum *whole = NULL;
    pir_status status = pir_sum_clone(sum, NULL, &whole);
    if (status == PIR_OK)
        status = pir_sum_clear_region(whole);
    if (status == PIR_OK)
        status = pir_sum_mesh(whole, precision, ret_mesh);
    pir_sum_destroy(whole);
    return status;
}

/* The mesh, where normals of P are turned. */
static pir_status mesh_at(pir_sum *sum, const pir_posed *posed, pir_precision precision, pir_mesh **ret_mesh) {
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_allocator *a = &pairing->allocator;
    pir_facet_list facets = {0};
    pir_status status = collect_facets(&facets, pairing, posed);
    // where nothing has area the sum is a point or a segment
    if (status == PIR_OK && facets.count == 0)
        status = pir_hull_mesh(pairing->p, pairing->q, pir_sum_shown_rotation(sum), a, precision, ret_mesh);
    else if (status == PIR_OK)
        // facets are told apart where the pairing is exact, vertices placed at the rotation that is shown
        status = pir_facet_list_mesh(&facets, a, posed, pir_sum_shown_rotation(sum), precision, ret_mesh);
    pir_facet_list_finish(&facets, a);
    return status;
}

pir_status pir_sum_mesh(pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh) {
    if (!sum || !ret_mesh || (precision != PIR_DOUBLE && precision != PIR_EXACT))
        return PIR_ERR_ARGUMENT;
    if (pir_sum_cone(sum)->set)
        return mesh_of_whole(sum, precision, ret_mesh);
    const pir_pairing *pairing = pir_sum_pairing(sum);
    pir_posed posed;
    pir_status status = pir_posed_init(&posed, &pairing->allocator, pairing->p, pairing->q, pir_sum_signs(sum));
    if (status == PIR_OK) {
        status = mesh_at(sum, &posed, precision, ret_mesh);
        pir_posed_finish(&posed, &pairing->allocator);
    }
    return status;
}
