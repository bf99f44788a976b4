/* displacement_lookup.h - F of a displaced surface where it is looked up at many places, one after the other. With a fitted spline each
   look-up would find the coefficients about it anew: they are found once for all.
   Layer 5, private to the renderer. */
#pragma once
#include "scene/scene.h"

typedef struct WrError WrError;
typedef struct WrField WrField;

/* wr_scene_height(raised.scene, raised.field, ...) is F. Zero-initialise; fini frees. */
typedef struct WrRaised {
    WrScene *scene;       /* own share */
    const WrField *field; /* borrowed, or `own`; NULL with a formula */
    WrField *own;
} WrRaised;

/* field: outlives `raised`; not read with a formula. Call fini even where it fails. Errors: no memory. */
bool wr_raised_init(WrRaised *raised, const WrScene *scene, const WrField *field, WrError *err);
void wr_raised_fini(WrRaised *raised);
/* Is the surface itself moved by F? */
bool wr_is_raised(const WrScene *scene);
/* No |F| is larger, object units. field: not read with a formula. */
double wr_raised_most(const WrScene *scene, const WrField *field);
