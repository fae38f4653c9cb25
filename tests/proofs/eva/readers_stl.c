/* SPDX-License-Identifier: MIT */
/* What Eva analyses: the reader of STL on any bytes, and on binary files of up to two triangles, of any corners. */
#include "readers_files.h"

#define HEADER   84
#define TRIANGLE 50

int main(void) {
    int all = (int)ask(pir_read_stl, "", 0, 2) | (int)ask(pir_read_stl, "", 0, 140);
    //@ loop unroll 3;
    for (char count = 0; count < 3; count++) {
        const char header[HEADER] = {[80] = count};
        all |= (int)ask(pir_read_stl, header, HEADER, TRIANGLE * (size_t)count);
    }
    return all;
}
