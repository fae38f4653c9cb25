/* SPDX-License-Identifier: MIT */
/* What Eva analyses: the reader of OBJ on any bytes. */
#define MOST 60

#include "readers_files.h"

int main(void) {
    return (int)ask(pir_read_obj, "", 0, 2) | (int)ask(pir_read_obj, "", 0, MOST);
}
