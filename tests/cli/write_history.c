/* SPDX-License-Identifier: MIT */
/* write_history FILE: the history of two boxes that come near each other and overlap. For tests of the command. */
#include <stdio.h>

#include <pirouette/history.h>
#include <pirouette/shape.h>

/* Notes of ten poses, the last of them with a rotation that is none. */
static pir_status note(pir_history *history, pir_polytope *box) {
    pir_pair_input input = pir_pair_input_default();
    pir_status status = pir_history_pair(history, box, box, NULL);
    for (int i = 0; i < 10 && status == PIR_OK; i++) {
        input.pose_p.rotation = (pir_quat){0, 0, i < 9 ? 1 : 0, i < 9 ? i : 0};
        input.pose_p.translation.x = 4 - 0.5 * i;
        status = pir_history_ask(history, &input);
    }
    return status;
}

int main(int argc, char **argv) {
    FILE *file = argc == 2 ? fopen(argv[1], "wb") : NULL;
    pir_polytope *box = NULL;
    pir_history *history = NULL;
    pir_status status = file ? pir_shape_create("cube", NULL, NULL, &box) : PIR_ERR_FILE;
    if (status == PIR_OK)
        status = pir_history_create(NULL, &history);
    if (status == PIR_OK)
        status = note(history, box);
    if (status == PIR_OK)
        status = pir_history_write(history, file, NULL);
    pir_history_destroy(history);
    pir_polytope_release(box);
    if (file && fclose(file) != 0)
        status = PIR_ERR_FILE;
    if (status != PIR_OK)
        fprintf(stderr, "write_history: %s\n", pir_status_text(status));
    return status == PIR_OK ? 0 : 1;
}
