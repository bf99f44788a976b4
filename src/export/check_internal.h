/* check_internal.h - the parts of a check (export/check.h). Private to this room. */
#pragma once
#include "export/check.h"

typedef struct WrImage WrImage;

/* Of each texel the first `colours` numbers; the rest is coverage. */
typedef struct WrCheckPicture {
    const WrImage *image;
    int colours;
} WrCheckPicture;

/* check_numbers.c */
void wr_check_numbers(const WrCheckPicture *picture, WrCheckNumbers *numbers);
/* The distance of two neighbouring numbers, as far as they tell; of floats 0. */
double wr_check_step(const WrCheckNumbers *numbers);

/* Of unit vectors out of codes that are `step` apart. */
void wr_check_curl(const WrImage *map, double step, WrCheckNormals *normals);
