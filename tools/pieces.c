/* SPDX-License-Identifier: MIT */
/* Pieces by file or folder. */
#include "pieces.h"

#include <stdlib.h>

#include "message.h"
#include "model.h"
#include "models.h"

static bool no_memory(const struct args *args) {
    complain("%s: out of memory", args->command->name);
    return false;
}

/* Takes the polytope, or releases it; NULL, after a complaint, gives false. */
static bool add(const struct args *args, struct pieces *pieces, pir_polytope *piece) {
    if (!piece)
        return false;
    if (pieces->count == pieces->room) {
        uint32_t room = pieces->room ? 2 * pieces->room : 16;
        pir_polytope **grown = realloc(pieces->at, room * sizeof *grown);
        if (!grown) {
            pir_polytope_release(piece);
            return no_memory(args);
        }
        pieces->at = grown;
        pieces->room = room;
    }
    pieces->at[pieces->count++] = piece;
    return true;
}

void pieces_release(struct pieces *pieces) {
    for (uint32_t i = 0; i < pieces->count; i++)
        pir_polytope_release(pieces->at[i]);
    free(pieces->at);
    *pieces = (struct pieces){0};
}

struct taking {
    const struct args *args;
    struct pieces *pieces;
};

static bool take_piece(void *context, const struct found_model *model) {
    struct taking *taking = context;
    return add(taking->args, taking->pieces,
               model->text ? model_of_text(taking->args, model->path, model->text, "obj")
                           : model_of_path(taking->args, model->path, NULL));
}

bool pieces_load(const struct args *args, size_t index, struct pieces *pieces) {
    return models_each(args, args->positional[index], take_piece, &(struct taking){args, pieces});
}
