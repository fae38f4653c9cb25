/* SPDX-License-Identifier: MIT */
/*
 * The table of subcommands, which is all that there is of them beside their cmd_*.c: meson takes from its lines
 * `.run = ` which files there are, for which program, and which manual pages. A text is one paragraph without line
 * breaks: whoever prints it wraps it. This file needs nothing but the C library, so that a cross build can make the
 * manual pages on the building machine.
 *
 * There are two programs of this table. `pirouette` has the subcommands that the core library serves, and starts in a
 * millisecond. `pirouette-slices` has all: what reads and makes slices needs HDF5 and MPI, whose own libraries take
 * tens of milliseconds to load. Each program compiles this file with a macro of its own. Where a subcommand has no run,
 * the first program hands its arguments over to the second (hand_over.h); where it can run as ranks of MPI, it does so
 * where a launcher has started it.
 */
#include "command.h"

#include <string.h>

#include <pirouette/io.h>

#if defined(PROGRAM_CORE)
#define CORE(run)   run
#define SLICES(run) NULL
#define RANKS(run)  run, .has_ranks = true
#elif defined(PROGRAM_SLICES)
#define CORE(run)   run
#define SLICES(run) run
#define RANKS(run)  run##_by_ranks
#else // the program that writes the manual pages runs none
#define CORE(run)   NULL
#define SLICES(run) NULL
#define RANKS(run)  NULL
#endif

#define HELP_OPTION                                                                                                    \
    {"-h, --help", NULL, "print this help"}, {                                                                         \
        NULL, NULL, NULL                                                                                               \
    }

/* Rows that the options of every subcommand but help end with. */
#define COMMON_OPTIONS {"--json", NULL, "print one JSON object"}, HELP_OPTION

/* Options of every subcommand that takes models; model.c reads how. */
#define MODEL_OPTIONS                                                                                                  \
    {"--merge", "T",                                                                                                   \
     "make facets of a model one that are coplanar within this length, as far as it moves no more (0)"},               \
        {"--require-convex", NULL, "refuse a model that is not convex, rather than take its hull"}, COMMON_OPTIONS

/* One rotation; pose.c reads them. */
#define POSE_OPTIONS                                                                                                   \
    {"--quat", "x,y,z,w", "turn P by this quaternion, exactly as given, of any length but 0"},                         \
        {"--axis", "x,y,z", "turn P about this axis, of any length but 0, ..."}, {                                     \
        "--angle", "DEGREES", "... by this angle"                                                                      \
    }

const char command_about[] = "Exact Minkowski sums of convex polyhedra, kept up to date while one of them rotates.";

#define ENDING(format) " ." #format
const char command_models[] = "A MODEL, P or Q is a file whose name ends in one of" PIR_READ_FORMATS(
    ENDING) "; - for OFF on standard input; or shape:NAME for a built-in one. Its convex hull is taken. A file to "
            "write "
            "may be - for standard output.";

const char command_exit[] =
    "0 done; 1 a check that was asked for failed; 2 bad usage or bad input, told in one line on stderr.";

const struct option command_options[] = {
    {"-h, --help", NULL, "print this help"},
    {"--version", NULL, "print the version"},
    {NULL, NULL, NULL},
};

/* Of each subcommand the function that runs it, and its options. */
command_run cmd_info;
static const struct option info_options[] = {
    {"--solid", NULL, "the model as the solid that it is: reflex edges, shells, genus, volume"},
    MODEL_OPTIONS,
};

command_run cmd_decompose;
static const struct option decompose_options[] = {
    {"-o", "DIR|FILE",
     "write the pieces: an OFF file each, exact, one object each in FILE.obj, or a picture, FILE.png"},
    {"--method", "best|facets|walls",
     "cut by planes of facets, by sight walls, which are vertical, or by what gives fewer pieces (best)"},
    {"--pieces", "N", "at most N pieces, which contain the solid"},
    {"--tolerance", "T", "fewer pieces, which contain the solid and reach out of it by this length at most"},
    COMMON_OPTIONS,
};

command_run cmd_clash;
static const struct option clash_options[] = {
    {"--within", "D", "of many solids, also tell those that are apart by at most this length (0)"},
    {"--tolerance", "T", "rank clashes last, as minor, that are at most this deep; it decides nothing (0)"},
    {"-o", "FILE", "draw the solids, those that clash in colour, to FILE, .svg"},
    COMMON_OPTIONS,
};

command_run cmd_certify;
static const struct option certify_options[] = {
    MODEL_OPTIONS,
};

command_run cmd_plan, cmd_plan_by_ranks;
static const struct option plan_options[] = {
    {"--from", "x,y,z[,x,y,z,w]",
     "where the robot is: a translation and, unless it is not turned, a quaternion; with --axis x,y,z,DEGREES"},
    {"--to", "x,y,z[,x,y,z,w]", "where it is to be, turned likewise"},
    {"--translate-only", NULL, "by translations alone, which is decided always; without it and --axis, by any motion"},
    {"--axis", "x,y,z", "by translations, between --bounds, and turns about this axis through the robot's origin"},
    {"--arcs", "N", "with --axis: divide the full turn into N arcs at most, 8, 16, ... 65536 (1024)"},
    {"--boxes", "N", "by any motion: divide all rotations into N boxes at most (65536)"},
    {"--memory", "MB", "by any motion: say unknown where boxes would take more than so many MiB (4096)"},
    {"--threads", "N", "by any motion: share the work among N threads; the answer is the same (1)"},
    {"--asymmetric", NULL, "by any motion: make each box by itself, where symmetries of bodies would save some"},
    {"--boxes-alone", NULL, "by any motion: do not look for walls whose holes are too narrow before boxes are made"},
    {"--resume", NULL,
     "by any motion: go on with FILE.part, which a run with this -o FILE has left, to the same answer; "
     "without this such a file is an error"},
    {"--dry-run", NULL, "by any motion: make 32 boxes, and tell about how long --boxes would take, but decide nothing"},
    {"--bounds", "x,y,z,x,y,z", "keep translations between these least and greatest ones (none)"},
    {"--open", NULL, "with --translate-only: bodies may touch, so passages count that the robot fits exactly"},
    {"--budget", "N", "fail, or with --axis say unknown, where more than N parts of space are needed"},
    {"-o", "FILE", "write the path, or the proof that there is none, to FILE, JSON in rationals"},
    {"--page", "FILE", "write a page that shows the path, or what is on either side of what blocks it, to FILE, .html"},
    COMMON_OPTIONS,
};

command_run cmd_simplify;
static const struct option simplify_options[] = {
    {"-o", "FILE", "write the polytope inside to FILE: .off, .obj, .stl, .ply or .svg"},
    {"--outer", "FILE", "write the one around, likewise"},
    {"--vertices", "N", "at most N vertices, 4 or more"},
    {"--error", "E", "stop where no point is farther than this length"},
    {"--exact", NULL, "in .off: integers and a/b instead of doubles, which hold the same numbers"},
    MODEL_OPTIONS,
};

command_run cmd_simulate;
static const struct option simulate_options[] = {
    {"-o", "FILE", "write a page that plays the run back to FILE, .html"},
    {"--record", "FILE",
     "write the poses of convex bodies, 60 frames a second, to FILE; docs/scenes.md has the format"},
    {"--list", NULL, "show the scenes that have a name"},
    {"--times", NULL, "put on the page how long the parts of updates took, which differs from run to run"},
    {"--seconds", "S", "simulate S seconds, to the nearest 1/60 (what the scene says, or 10)"},
    {"--awake", NULL, "let no body sleep"},
    {"--threads", "N", "find contacts with N threads; the run is the same (1)"},
    {"--reuse", "D", "tell contacts again while bodies move by less than this length against each other (0)"},
    COMMON_OPTIONS,
};

command_run cmd_replay;
static const struct option replay_options[] = {
    COMMON_OPTIONS,
};

command_run cmd_distance;
static const struct option distance_options[] = {
    {"--quat", "x,y,z,w", "turn A by this quaternion, exactly as given, of any length but 0"},
    {"--axis", "x,y,z", "turn A about this axis, of any length but 0, ..."},
    {"--angle", "DEGREES", "... by this angle"},
    {"--translate", "x,y,z", "then move A by this (0,0,0)"},
    {"--farthest", NULL, "the greatest distance of any two points, not the least"},
    {"--within", "D", "also list all pairs of triangles whose distance is at most this length"},
    {"-o", "FILE", "draw both meshes and the points to FILE, .svg"},
    COMMON_OPTIONS,
};

command_run cmd_events;
static const struct option events_options[] = {
    {"--axis", "x,y,z", "the axis of the turn, of any length but 0 (0,0,1)"},
    {"--quat", "x,y,z,w", "turn P by this quaternion first, exactly as given, of any length but 0"},
    {"--from", "DEGREES", "leave out what comes before this angle (0)"},
    {"--to", "DEGREES", "leave out what comes after this angle (360)"},
    {"--difference", NULL, "of the sum of Q and the reflected, turned P"},
    {"--plot", "FILE", "draw how many facets the sum has over the angle to FILE, .svg"},
    MODEL_OPTIONS,
};

command_run cmd_impact;
static const struct option impact_options[] = {
    {"--axis", "x,y,z", "turn P about this axis, of any length but 0, ..."},
    {"--pivot", "x,y,z", "... through this point (0,0,0), ..."},
    {"--angle", "DEGREES", "... by this angle, from -360 to 360 (360)"},
    {"--way", "x,y,z", "move P by this; beside --axis, a screw of less than 180 degrees"},
    {"--proportional", NULL, "the way proportional to the angle, up to 36000 degrees: bounds instead of a root"},
    {"--quat", "x,y,z,w", "turn P by this quaternion first, exactly as given, of any length but 0, ..."},
    {"--translate", "x,y,z", "... then move it by this (0,0,0): where it starts"},
    {"--solid", NULL, "the models as the solids that they are, in convex pieces"},
    MODEL_OPTIONS,
};

command_run cmd_cgm;
static const struct option cgm_options[] = {
    POSE_OPTIONS,
    {"--difference", NULL, "reflect P through the origin before it is turned"},
    {"-o", "FILE", "draw the unfolded cube to FILE, .svg: arcs of P red, of Q blue, of both violet"},
    MODEL_OPTIONS,
};

command_run cmd_shape;
static const struct option shape_options[] = {
    {"-o", "FILE", "write the model to FILE: .off, .obj, .stl, .ply or .svg"},
    {"--exact", NULL, "in .off: integers and a/b instead of doubles, which hold the same numbers"},
    {"--list", NULL, "list the names and their parameters, as without arguments"},
    COMMON_OPTIONS,
};

command_run cmd_sum;
static const struct option sum_options[] = {
    POSE_OPTIONS,
    {"--difference", NULL, "the sum of Q and the reflected, turned P: what P may be moved by to touch Q"},
    {"--method", "walk|cgm|hull|object",
     "by walking the Gaussian maps (default), by overlaying the cubical ones, as the hull of all sums, or from all "
     "normals (simple bodies)"},
    {"--exact", NULL, "exact coordinates; in .off: integers and a/b instead of doubles"},
    {"--solid", NULL, "P and Q as the solids that they are, not their hulls; -o then takes .off"},
    {"--open", NULL, "with --solid: without their boundaries, so that tight passages are left out"},
    {"-o", "FILE", "write the sum to FILE: .off, .obj, .stl, .ply or .svg; of solids .off or .png"},
    {"--certificate", "FILE",
     "write what proves the sum to FILE, for check/check.py; of solids for check/solid_sum.py"},
    MODEL_OPTIONS,
};

command_run cmd_track;
static const struct option track_options[] = {
    {"--steps", "N", "frames to a full turn (500)"},
    {"--frames", "N", "frames in all (1000)"},
    {"--axis", "x,y,z|random", "turn about this axis, or about a new random one every 50 frames (random)"},
    {"--seed", "N", "of the random axes (1)"},
    {"--method", "auto|update|walk|cgm|rebuild",
     "how each rotation is brought into the sum (auto); with --solid auto, update or rebuild, else not rebuild"},
    {"--tolerance", "T", "let the pairing stay behind while its support falls short by at most this length (0)"},
    {"--region", "x,y,z,DEGREES", "keep only facets whose normals are within so many degrees of the axis (180: all)"},
    {"--verify", NULL, "hold every frame against a rebuilt sum; exit status 1 when one differs"},
    {"--verify-every", "K", "hold frames 0, K, 2K, ... against a rebuilt sum"},
    {"--brute", NULL, "also time the re-check of all pairs, on a few frames"},
    {"--difference", NULL, "keep the sum of Q and the reflected, turned P"},
    {"--solid", NULL, "P and Q as the solids that they are, not their hulls"},
    {"--open", NULL, "with --solid: without their boundaries, so that tight passages are left out"},
    {"--dump", "DIR",
     "write frames as OFF in doubles into DIR, in rationals into DIR/exact, and what they are to DIR/frames.json"},
    {"--exact", NULL, "dump frames in rationals alone, into DIR"},
    {"--every", "K", "dump frames 0, K, 2K, ... (1)"},
    {"--plot", "FILE.svg", "draw update and rebuild time over frames"},
    MODEL_OPTIONS,
};

command_run cmd_query;
static const struct option query_options[] = {
    POSE_OPTIONS,
    {"--translate", "x,y,z", "move P by this, after turning it"},
    {"--solid", NULL, "P and Q as the solids that they are, by their pieces, not their hulls"},
    {"--direction", "x,y,z", "also how far P moves this way to leave Q, or to touch it; of hulls, not of solids"},
    {"--cast", "x,y,z", "also when P touches Q while it moves by this"},
    {"--radius-p", "R", "round P by a ball of this radius"},
    {"--radius-q", "R", "round Q"},
    {"--certificate", "FILE",
     "write what proves the answer to FILE, for check/check.py, of solids check/solids.py; without radii"},
    {"--prove", "state|number",
     "what of the answer the certificate proves: its state, or distance or depth (number); no depth of solids"},
    {"--batch", "FILE.csv", "many placements: a translation x,y,z a line; answers go to -o; - is standard input"},
    {"-o", "FILE", "a picture of both bodies with the answer drawn, .svg; with --batch the answers, .csv"},
    MODEL_OPTIONS,
};

command_run cmd_slice;
static const struct option slice_options[] = {
    {"--axis", "x,y,z", "turn the robot about this axis, of any length but 0, ..."},
    {"--steps", "N", "... in so many equal turns"},
    {"--grid", "hopf", "all rotations, ..."},
    {"--level", "L",
     "... by the grid of 72 times 8 to the power of L of them, 60 degrees by 2 to the power of L apart"},
    {"--rotations", "FILE", "the rotations of FILE, .csv or .npy: quaternions x,y,z,w, of any length but 0"},
    {"--critical", NULL,
     "slices without gaps: with --axis alone, the events of a full turn and what is between them, into a .turn"},
    {"--quat", "x,y,z,w", "of --critical: where the turn starts (0,0,0,1), of any length but 0"},
    {"-o", "FILE", "the file that is made: .h5 or .hdf5, of --critical .turn"},
    {"--threads", "N", "make slices in so many threads (1)"},
    {"--slices-per-unit", "N",
     "deal slices to threads and ranks so many at a time, at most 1048576 (256, or 64 where there are few in all)"},
    {"--resume", NULL, "go on where an earlier run of the same ended, however it ended"},
    {"--dry-run", NULL, "only say how many slices there are, how long they will take and how large they will be"},
    {"--planes", NULL, "also write the planes of every slice, as doubles"},
    {"--vertices", NULL, "also write the vertices of every slice, as doubles"},
    {"--planar", "z=NUMBER",
     "also write planar sections of every slice, where x, y or z is this, once the file is whole"},
    MODEL_OPTIONS,
};

command_run cmd_configuration;
static const struct option configuration_options[] = {
    {"--quat", "x,y,z,w", "the robot is turned by this quaternion, of any length but 0"},
    {"--axis", "x,y,z", "turned about this axis, of any length but 0, ..."},
    {"--angle", "DEGREES", "... by this angle"},
    {"--translate", "x,y,z", "moved by this, after turning it"},
    {"--kappa", "K", "of a .turn: turned by the angle t from its start, of which this is |axis| cot(t/2)"},
    {"--around", NULL, "of a .turn: the states at this translation all around, and the angles between them"},
    {"--to", "x,y,z", "ask for the motion that ends at this translation"},
    {"--to-quat", "x,y,z,w", "ask for the motion that ends at this rotation"},
    {"--batch", "FILE",
     "many poses, x,y,z,w,tx,ty,tz a line, or an .npy of such rows; answers go to -o; - is standard input"},
    {"-o", "FILE.csv", "where the answers of --batch go"},
    COMMON_OPTIONS,
};

command_run cmd_view;
static const struct option view_options[] = {
    {"-o", "FILE",
     "what to make: .off, .obj, .stl or .ply, one difference; .svg, a contact sheet; .html, a page with a slider; "
     ".vtkhdf, for ParaView"},
    {"--slice", "K", "only slice K, counted from 0"},
    {"--every", "K", "slices 0, K, 2K, ... (as few as make at most 60 views of a sheet, 2000 of a page)"},
    {"--pair", "P,Q", "of a mesh: which piece of the robot and which of the obstacles, counted from 0 (0,0)"},
    {"--exact", NULL, "of a mesh in .off: integers and a/b instead of doubles"},
    {"--planar", "z=NUMBER", "of a sheet: planar sections instead of bodies, where x, y or z is this"},
    COMMON_OPTIONS,
};

command_run cmd_help;
static const struct option help_options[] = {HELP_OPTION};

const struct command command_table[] = {
    {
        .name = "info",
        .run = CORE(cmd_info),
        .positional = {"MODEL"},
        .required = 1,
        .summary = "vertices, edges, facets of a model's exact convex hull, its bounds and volume, and what the "
                   "model is before its hull is taken",
        .options = info_options,
        .examples = {{"info shape:icosahedron", "the counts, bounds and volume of a built-in model"}},
    },
    {
        .name = "cgm",
        .run = CORE(cmd_cgm),
        .positional = {"P", "Q"},
        .required = 1,
        .summary = "the cubical Gaussian map of P, turned, or of the sum of P and Q",
        .details =
            "Vertices, halfedges and faces of the six planar maps, their squares and outer faces included. Of two "
            "models it is the overlay of their maps, which is the map of their sum.",
        .options = cgm_options,
        .examples = {{"cgm shape:cube shape:octahedron -o map.svg", "draw the map of a sum"}},
    },
    {
        .name = "shape",
        .run = CORE(cmd_shape),
        .positional = {"NAME"},
        .required = 0,
        .summary = "write a built-in model to a file, or list all",
        .details = "NAME may carry parameters, as in 'geodesic?level=4' or 'box?x=1&y=2&z=0.5'.",
        .options = shape_options,
        .examples = {{"shape --list", "the names and their parameters"},
                     {"shape 'geodesic?level=4' -o sphere.off", "write a model"}},
    },
    {
        .name = "sum",
        .run = CORE(cmd_sum),
        .positional = {"P", "Q"},
        .required = 2,
        .summary = "the Minkowski sum of P, turned, and Q",
        .details = "Vertices, edges and facets are those of the sum; fv, vf and ee count its pairs of features "
                   "(facet of P "
                   "and vertex of Q, the reverse, an edge of each) as they are when every tie is settled.",
        .options = sum_options,
        .examples = {{"sum shape:cube shape:gs4 --axis 0,0,1 --angle 30 -o sum.off", "turn the cube and write the sum"},
                     {"sum shape:cube shape:cube --quat 1,2,3,4 --exact -o sum.off", "the same in exact numbers"},
                     {"sum shape:cube shape:cube --solid -o sum.off", "as solids, convex or not"}},
    },
    {
        .name = "track",
        .run = CORE(cmd_track),
        .positional = {"P", "Q"},
        .required = 2,
        .summary = "keep the sum of P and Q up to date while P turns, and time it",
        .details = "Frame 0 is P as it stands; each frame turns it by 1/steps of a full turn. Times are of the sum's "
                   "pairing: one call that brings the sum to the frame's rotation. Rebuilds are timed on a sample of "
                   "frames in the same run.",
        .options = track_options,
        .examples = {{"track shape:cube shape:gs4 --frames 100 --verify", "hold every frame against a rebuilt sum"},
                     {"track shape:cube shape:gs4 --frames 100 --plot times.svg --json", "draw the times"},
                     {"track shape:cube shape:cube --solid --frames 100", "as solids, convex or not"}},
    },
    {
        .name = "events",
        .run = CORE(cmd_events),
        .positional = {"P", "Q"},
        .required = 2,
        .summary = "the angles at which the sum of P and Q changes while P makes a full turn, exactly",
        .details = "Each angle is a root of a quadratic with integer coefficients in kappa, which is the length of the "
                   "axis times the cotangent of half the angle. It is told with the facets that the sum loses and "
                   "gains there; changes at one angle are one event.",
        .options = events_options,
        .examples = {{"events shape:cube shape:octahedron --axis 1,2,3", "all of a turn"},
                     {"events shape:cube shape:gs4 --from 10 --to 20 --json", "some, with their facets"}},
    },
    {
        .name = "impact",
        .run = CORE(cmd_impact),
        .positional = {"P", "Q"},
        .required = 2,
        .summary = "when P, turning about an axis, going straight on, or both, first touches Q, exactly",
        .details =
            "The outcome is hit, miss, receding (P touches Q at the start and leaves it), start inside or at "
            "rest, and is exact: a graze is a hit. The angle and the fraction of the motion are rounded down. "
            "The contact is a root of a quadratic with integer coefficients in kappa, which is the length of "
            "the axis times the cotangent of half the angle, or 1 through the fraction of a way. With both an "
            "axis and a way P goes the way as the tangent of half the angle grows; the contact is a root of a "
            "cubic. With --proportional P screws as a bolt does, through up to a hundred turns. The outcome then "
            "is free, meets or undecided, and never wrong: there is no contact before the first of the two "
            "angles; where they meet there is one at the second, or before it.",
        .options = impact_options,
        .examples = {{"impact shape:cube shape:cube --axis 0,0,1 --pivot 3,3,0 --translate 0,5,0", "a door"},
                     {"impact shape:cube shape:gs4 --translate 3,0,0 --way -4,0,0 --json", "a way, with the faces"},
                     {"impact shape:cube shape:cube --translate 0,0,3 --axis 0,0,1 --angle 90 --way 0,0,-3", "a screw"},
                     {"impact shape:cube shape:cube --translate 0,0,9 --axis 0,0,1 --angle 1440 --way 0,0,-9 "
                      "--proportional",
                      "a bolt"}},
    },
    {
        .name = "query",
        .run = CORE(cmd_query),
        .positional = {"P", "Q"},
        .required = 2,
        .summary = "overlap, distance and depth of P, turned and moved, against Q",
        .details =
            "The state, outside, boundary or inside, is exact; numbers are doubles. The witness names the features "
            "that attain the answer: v, e or f of P, then of Q, and their indices. Moving P by depth times normal "
            "parts the bodies.",
        .options = query_options,
        .examples = {{"query shape:cube shape:cube --translate 3,0,0", "the distance of two cubes"},
                     {"query shape:cube shape:gs4 --translate 3,0,0 --cast -4,0,0", "also when the cube touches"}},
    },
    {
        .name = "slice",
        .run = SLICES(cmd_slice),
        .positional = {"ROBOT", "OBSTACLE..."},
        .required = 2,
        .summary = "the differences of a robot and obstacles at every rotation of a grid, in one HDF5 file",
        .details =
            "A ROBOT or OBSTACLE is a model, an OBJ file of several objects, or a folder of models; each object or "
            "model is a convex piece. Every pair of pieces is followed from rotation to rotation, and the file "
            "holds what changes. Until all slices are made they stand in FILE.part0: a run that was ended in any "
            "way goes on with --resume. Started by mpirun, where "
            "the build has MPI, processes share the work, each with a part of its own. With --critical the file holds "
            "a full turn about one axis whole: every angle at which a difference changes, exactly, and its facets "
            "between them.",
        .options = slice_options,
        .examples = {{"slice shape:cube shape:gs4 --axis 0,0,1 --steps 500 -o slices.h5", "the cube about one axis"},
                     {"slice shape:cube shape:gs4 --axis 0,0,1 --critical -o cube.turn", "every angle of the turn"},
                     {"slice shape:cube shape:gs2 --grid hopf --level 2 --dry-run",
                      "what all rotations, 15 degrees apart, would take"}},
    },
    {
        .name = "configuration",
        .run = SLICES(cmd_configuration),
        .positional = {"FILE.h5|FILE.turn"},
        .required = 1,
        .summary = "whether a pose of the robot is free or blocked, by the slices of a file",
        .details = "Free: no piece of the robot overlaps or touches an obstacle. Blocked: some piece does. Unknown: "
                   "the slices prove neither. At the rotation of a slice the state, outside, boundary or inside, is "
                   "exact. A file of slice --critical decides every pose, and has the state of each.",
        .options = configuration_options,
        .examples = {{"configuration slices.h5 --quat 0,0,1,1 --translate 3,0,0", "one pose"},
                     {"configuration slices.h5 --translate 3,0,0 --to -3,0,0", "a motion, where it is not free"},
                     {"configuration slices.h5 --batch poses.csv -o answers.csv", "many poses"},
                     {"configuration cube.turn --translate 1,0,0 --around", "at which angles a place is free"}},
    },
    {
        .name = "view",
        .run = SLICES(cmd_view),
        .positional = {"FILE.h5"},
        .required = 1,
        .summary = "slices of a file as a mesh, a contact sheet, a page with a slider, or a file for ParaView",
        .details = "A sheet and a page show the differences of all pairs of pieces, what is behind others hidden. "
                   "A file of "
                   "VTK holds a partition and a step for each slice, with the pair and the kind of each facet.",
        .options = view_options,
        .examples = {{"view slices.h5 -o sheet.svg", "a grid of small views"},
                     {"view slices.h5 -o slices.html", "a page that needs nothing else"},
                     {"view slices.h5 --slice 17 --pair 0,0 -o one.ply", "one difference as a mesh"}},
    },
    {
        .name = "decompose",
        .run = CORE(cmd_decompose),
        .positional = {"MODEL"},
        .required = 1,
        .summary = "divide a solid into convex pieces, exactly",
        .details = "The pieces have disjoint insides, and the solid is their union. They are cut along planes of "
                   "facets, or of vertical walls, and joined where that leaves them convex. With --pieces or "
                   "--tolerance they contain the solid: pairs are replaced by their hulls, and how far these reach "
                   "out is proven and printed.",
        .options = decompose_options,
        .examples = {{"decompose shape:cube -o pieces.obj", "one object a piece"},
                     {"decompose shape:cube --tolerance 0.01 --json", "fewer, and how far they reach out"}},
    },
    {
        .name = "clash",
        .run = CORE(cmd_clash),
        .positional = {"A|FOLDER", "B"},
        .required = 1,
        .summary = "what two solids, or any two of many, have in common: verdicts on clashes, exactly",
        .details = "A and B are solids where they stand. One argument is a folder of models, or an OBJ file of "
                   "several objects: all pairs are looked at. Each is apart, touching, or a clash: protrusion, "
                   "piercing, envelope or duplicate. A model that is no solid is named, and the others are answered; "
                   "the exit status is 2 then.",
        .options = clash_options,
        .examples = {{"clash shape:cube shape:cube", "a duplicate"},
                     {"clash shape:cube shape:geodesic?level=2 -o clash.svg", "with a picture"}},
    },
    {
        .name = "certify",
        .run = CORE(cmd_certify),
        .positional = {"PIECES", "MODEL"},
        .required = 2,
        .summary = "which volume given pieces add to a solid and lose of it, exactly",
        .details = "PIECES is an OBJ file of several objects, a folder of models, or one model; each piece is the "
                   "convex hull of its points, and pieces may overlap, as those of CoACD and V-HACD do. Added is the "
                   "volume of the pieces without the solid, lost that of the solid without the pieces, both as "
                   "rationals: nothing is sampled.",
        .options = certify_options,
        .examples = {{"certify shape:cube shape:cube", "nothing is added or lost"}},
    },
    {
        .name = "plan",
        .run = RANKS(cmd_plan),
        .positional = {"ROBOT", "OBSTACLE..."},
        .required = 2,
        .summary = "whether a solid can be moved from one place to another between solids, with the proof",
        .details =
            "By any motion, or with turns about one axis, or by translations at one rotation. A folder of models, or "
            "an OBJ file of several objects, is several solids: those of ROBOT move together. The answer is proven: a "
            "path, of which each motion is free, or no path, with a division of space that proves it. Without turns "
            "there is always one; with turns it is unknown where a passage is too narrow, or not narrow enough, for "
            "the boxes or arcs. Bodies are closed and may not touch, unless --open. Without --bounds, which turns "
            "need, all of space is there. check/plan.py, check/turns.py with --axis, or check/motions.py checks the "
            "file without the library; docs/plan.md has its format.",
        .options = plan_options,
        .examples = {{"plan shape:cube shape:gs4 --translate-only --from=-3,0,0 --to 3,0,0", "round a body"},
                     {"plan shape:cube shape:gs4 --translate-only --from=-3,0,0 --to 3,0,0 -o plan.json",
                      "with what proves it"},
                     {"plan shape:cube shape:cube --axis 0,0,1 --bounds=-4,-4,-4,4,4,4 --from=-3,0,0 --to 3,0,0,90",
                      "and a quarter turn"},
                     {"plan shape:cube shape:cube --bounds=-4,-4,-4,4,4,4 --from=-3,0,0 --to 3,0,0,1,1,0,1",
                      "and any turn"}},
    },
    {
        .name = "simplify",
        .run = CORE(cmd_simplify),
        .positional = {"MODEL"},
        .required = 1,
        .summary = "a polytope of fewer vertices inside a model, and one around it",
        .details = "Both with a proven bound on how far they are from the model. The inner one has vertices of the "
                   "model, the outer one planes of its facets.",
        .options = simplify_options,
        .examples = {{"simplify shape:geodesic --vertices 30 -o inner.off --outer outer.off", "by vertices"},
                     {"simplify shape:geodesic --error 0.01", "how many vertices an error takes"}},
    },
    {
        .name = "simulate",
        .run = CORE(cmd_simulate),
        .positional = {"SCENE.json"},
        .required = 0,
        .summary = "run a scene of rigid bodies, as a page that plays it back",
        .details = "The scene says shapes, by model or by points, and bodies; docs/scenes.md has its keys, "
                   "examples/scenes has scenes. Those of --list may be named as scene:NAME. Files of models are looked "
                   "for from its folder on. Steps are of 1/240 s, and a run is the same on every machine.",
        .options = simulate_options,
        .examples = {{"simulate scene:cards -o cards.html", "a page that needs nothing else"},
                     {"simulate pile.json --seconds 5 --record pile.bin", "poses for a replay"}},
    },
    {
        .name = "replay",
        .run = CORE(cmd_replay),
        .positional = {"FILE"},
        .required = 1,
        .summary = "run a history of calls on a sum, a pair or a scene, with hashes of what they give",
        .details = "A program writes the file with pir_history_write. The same file gives the same hashes on every "
                   "machine: where they differ from those of another build, the first line that does tells the "
                   "call. docs/replay.md has the format.",
        .options = replay_options,
        .examples = {{"replay wrong.history", "a line for each call, and a hash of all"}},
    },
    {
        .name = "distance",
        .run = CORE(cmd_distance),
        .positional = {"A", "B"},
        .required = 2,
        .summary = "the nearest or farthest triangles of two meshes as they are, not their hulls",
        .details = "A and B are models whose facets are surfaces, open or closed; facets of more than three "
                   "corners are cut into triangles, which count in the order of the file. The state is apart or "
                   "meet, or, of closed meshes, which of them has a part within the other. Which triangles they "
                   "are is exact; of equals the lowest numbers are told.",
        .options = distance_options,
        .examples = {{"distance shape:cube shape:gs4 --translate 3,0,0", "how far apart two meshes are"},
                     {"distance shape:cube shape:cube --translate 3,0,0 --within 2 --json",
                      "with the triangles at most 2 apart"}},
    },
    {
        .name = "help",
        .run = CORE(cmd_help),
        .positional = {"SUBCOMMAND"},
        .required = 0,
        .summary = "what the command does, or a subcommand",
        .options = help_options,
        .examples = {{"help sum", "the same as pirouette sum --help"}},
    },
    {.name = NULL},
};

const struct command *command_find(const char *name) {
    for (const struct command *command = command_table; command->name; command++)
        if (strcmp(command->name, name) == 0)
            return command;
    return NULL;
}

bool positional_repeats(const char *name) {
    size_t length = strlen(name);
    return length > 3 && strcmp(name + length - 3, "...") == 0;
}

bool option_is(const struct option *option, const char *text, size_t length) {
    for (const char *name = option->name; *name;) {
        size_t own = strcspn(name, ",");
        if (own == length && memcmp(name, text, length) == 0)
            return true;
        name += own;
        name += strspn(name, ", ");
    }
    return false;
}
