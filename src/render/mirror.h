/* mirror.h - the surroundings as kernels look them up in mirrored directions: as they are, or blurred by a material's lobe.
   Layer 5, private to the renderer. Kept from frame to frame. */
#pragma once
#include "shade/gloss.h"
#include "shade/surround.h"

#include <stdbool.h>

typedef struct WrPool WrPool;

typedef struct WrMirror {
    WrSurround *source; /* own share; NULL: nothing is held */
    WrGloss gloss;      /* what it is blurred by; lobe none: not */
    double fine;
    int width, height, pitch; /* texels; pitch: of a row with the one beside it on either side */
    float *rgba;              /* [height + 2][pitch][4], with a row above and below, A 0; owned */
} WrMirror;

/* gloss NULL: not blurred. fine: as of wr_blur_width. Errors: no memory, cancelled: it is empty then. */
bool wr_mirror_bring(WrMirror *mirror, const WrSurround *surround, const WrGloss *gloss,
                     double fine, WrPool *pool, WrError *err);
void wr_mirror_drop(WrMirror *mirror);
