/* displacement_lookup.h - F of a displaced surface, prepared for many single evaluations.
   Private to the renderer. With a fitted spline each evaluation would compute the nearby coefficients again;
   here they are computed once. */
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

/* Prepares F. field: must outlive `raised`; not read with a formula. Call fini even after a failure. Errors: no
   memory. */
bool wr_raised_init(WrRaised *raised, const WrScene *scene, const WrField *field, WrError *err);
void wr_raised_fini(WrRaised *raised);
/* True if F displaces the surface itself. */
bool wr_is_raised(const WrScene *scene);
/* Upper bound of |F|, object units. field: not read with a formula. */
double wr_raised_most(const WrScene *scene, const WrField *field);
