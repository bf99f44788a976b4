/* mypaint_engine.h - generation of a preset's dabs by libmypaint.
   Private to this module.

   The engine is driven in fixed steps of WR_ENGINE_STEP seconds, interpolated from the samples, so that
   the division of the motion into events has no effect: samples on one straight, uniform motion give
   the dabs of its two ends. Samples without times move at WR_ENGINE_SPEED. A rest longer than
   WR_ENGINE_REST is shortened to that, and a motion slower than 4 texels per second is shortened in the
   same way. A step stops at corners that it would cut by more than 1/4 texel. The middle of a segment
   longer than 65536 texels is skipped. A stroke without dabs, such as a tap, makes one when it ends.

   Smudging: the library's colour represents heights. get_color returns (h, 1, 1, 1) for the mean height
   h; the brush's own colour is black; so the green of a dab's colour is the smudge amount (drag), and
   the library's state SMUDGE_RA is the dragged height, unbounded.

   Tilt is MyPaint's: x to the right, y towards the user, 1 is 60 degrees; ascension is the direction of
   the pen's tilt, in degrees, 0 towards the user, 90 to the left. The pen's turn is interpolated the
   short way. Angles of dabs, clockwise in the library, are converted to anticlockwise. The alpha of an
   eraser's dabs is the erased fraction; for other presets the fraction not erased.

   Randomness: the library's random numbers always start equally; the seed selects one of 16384 start
   positions in their sequence. At most about 65536 dabs are made per step. */
#pragma once
#include "brush/dab.h"
#include "brush/preset.h"

#include <stdbool.h>

#define WR_ENGINE_STEP 0.00390625 /* seconds: 1/256, exact in binary */
#define WR_ENGINE_SPEED 400.0     /* texels a second */
#define WR_ENGINE_REST 1.0        /* seconds */

typedef struct WrEngine WrEngine;

/* brush: sane, with its preset. Its radius and hardness replace the preset's base values; flow, seed,
 * angle, aspect, follow and jitter are applied, and the tip's cell is selected; mode, strength and
 * similar settings are left to the caller. The preset's own angle is used if its dabs are elongated, or
 * if a curve changes the angle. Shares preset and tip. Dabs are finite, with alpha > 0. A radius below
 * 0.2 becomes 0.2; 0 makes none. The caller owns the engine. */
WrEngine *wr_engine_new(const WrBrush *brush, const WrDabSink *sink);
void wr_engine_free(WrEngine *engine); /* NULL is allowed */

typedef struct WrEnginePoint {
    double x, y; /* texels, not wrapped: continuous along the stroke, any size */
    double pressure, tilt_x, tilt_y;
    double seconds;  /* since the stroke's start */
    double turn_deg; /* of the pen about its own axis, any angle */
} WrEnginePoint;

/* Adds one more point without drawing. */
void wr_engine_push(WrEngine *engine, const WrEnginePoint *point);
/* Makes one step, which may make dabs. False if there was none to do. */
bool wr_engine_step(WrEngine *engine);
/* Called when the pen is lifted: the rest of the path becomes available as further steps. */
void wr_engine_pen_up(WrEngine *engine);
