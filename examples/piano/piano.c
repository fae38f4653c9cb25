/* SPDX-License-Identifier: MIT */
/*
 * Moves a piano through a gap that it does not fit straight: slices its configuration space, finds a way by asking the
 * slices alone, checks the way at 10,000 points by exact queries, and draws it.
 *
 *     piano SLICES.h5 PATH.svg
 */
#include <stdio.h>

#include "draw.h"
#include "place.h"
#include "plan.h"

enum { POINTS = 10000 };

int main(int argc, char **argv) {
    static world piano;
    static spot path[PATH_ROOM];
    if (argc != 3) {
        fprintf(stderr, "usage: piano SLICES.h5 PATH.svg\n");
        return 2;
    }
    int done = place_make(&piano, argv[1]);
    int found = done ? plan(&piano, &spot_start, &spot_goal, path) : 0;
    int count = found ? shorten(&piano, path, found, 200) : 0;
    int bad = count ? place_check(&piano, path, count, POINTS) : -1;
    if (piano.error) {
        fprintf(stderr, "piano: %s: %s\n", piano.error, piano.report.text);
    } else if (!count) {
        fprintf(stderr, "piano: no way was found\n");
    } else {
        printf("%d pairs of pieces at %d rotations\n", ROBOT_PIECES * OBSTACLES, STEPS);
        printf("a path of %d spots, shortened to %d\n", found, count);
        for (int i = 0; i < count; i++)
            printf("  %+.17g %+.17g %+.17g %+.17g\n", path[i].x, path[i].y, path[i].z, path[i].turn);
        printf("%d points asked, %d overlap\n", POINTS, bad);
        done = draw_path(&piano, path, count, 40, argv[2]);
    }
    place_clear(&piano);
    return done && count && bad == 0 ? 0 : 1;
}
