/* SPDX-License-Identifier: MIT */
/* The figures of the paper's Figure 3 and Table 1, by its order of columns: row i holds the cells
   beside columns 0 to i. */
#include "paper.h"

const struct paper_model paper_model[PAPER_MODELS] = {
    {"cone", "cone", 78},
    {"cube", "cube", 12},
    {"cylinder", "cylinder", 140},
    {"DD", "dd", 32},
    {"ellipse", "ellipse", 960},
    {"GS1", "gs1", 80},
    {"GS2", "gs2", 180},
    {"GS3", "gs3", 320},
    {"GS4", "gs4", 500},
    {"HP", "hp", 10},
    {"T", "t", 60},
    {"TI", "ti", 236},
    {"v-rod", "vrod", 324},
};

static const double table[PAPER_MODELS][PAPER_MODELS] = {
    {9.26},
    {8.58, 10.50},
    {12.83, 10.31, 18.73},
    {9.82, 9.85, 13.33, 10.93},
    {24.97, 14.50, 47.51, 21.67, 176.34},
    {15.09, 11.21, 23.66, 15.39, 51.38, 25.23},
    {19.73, 12.15, 32.96, 17.95, 86.99, 33.16, 52.73},
    {22.92, 12.42, 40.45, 19.63, 120.23, 38.88, 65.53, 86.26},
    {24.50, 12.70, 45.22, 20.19, 146.15, 44.21, 73.89, 100.15, 121.26},
    {8.02, 9.32, 9.59, 9.25, 13.19, 9.75, 10.84, 11.58, 11.51, 9.00},
    {14.50, 11.16, 20.66, 14.05, 35.95, 20.33, 26.01, 29.21, 31.83, 10.28, 16.17},
    {21.30, 13.87, 35.55, 19.53, 91.48, 38.02, 56.86, 69.25, 78.26, 12.78, 28.08, 63.45},
    {20.30, 18.31, 34.00, 21.92, 88.30, 46.53, 65.46, 77.73, 83.05, 15.76, 34.23, 67.24, 123.75},
};

double paper_speedup(unsigned i, unsigned j) {
    return i > j ? table[i][j] : table[j][i];
}
