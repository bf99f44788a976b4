/* check_internal.h - functions shared by the parts of a check (export/check.h). Private to this module. */
#pragma once
#include "export/check.h"

typedef struct WrImage WrImage;

/* A picture whose first `colours` numbers per texel are checked; the rest is coverage. */
typedef struct WrCheckPicture {
    const WrImage *image;
    int colours;
} WrCheckPicture;

/* check_numbers.c */
void wr_check_numbers(const WrCheckPicture *picture, WrCheckNumbers *numbers);
/* Distance of two neighbouring numbers, as far as known; 0 for floats. */
double wr_check_step(const WrCheckNumbers *numbers);

/* Computes curl for unit vectors from codes that are `step` apart. */
void wr_check_curl(const WrImage *map, double step, WrCheckNormals *normals);
