/* engine.h - libmypaint makes the dabs of a preset's stroke.
   Private to this module. The engine is fed at fixed steps of WR_ENGINE_STEP seconds, interpolated
   from the samples, so that how the motion was cut into events does not matter: samples that lie on one
   straight, even motion give the dabs of its two ends. Samples without time of their own move at
   WR_ENGINE_SPEED. A rest longer than WR_ENGINE_REST counts as that long, and a motion slower than 4 texels
   a second is cut in the same way. A step goes by way of corners that it would cut by more than 1/4
   texel. Of a way between two points that is longer than 65536 texels the middle is left out. A stroke
   that makes no dab by itself, such as a tap, makes one when it ends.

   Smudging: the library's colour carries heights. get_color answers (h, 1, 1, 1) for the mean height h;
   the brush's own colour is black; so green of a dab's colour is how much it smudges (drag), and the
   library's state SMUDGE_RA is the height dragged along, unbounded.

   Tilt is MyPaint's: x to the right, y towards the user, 1 is 60 degrees; ascension is the side that the
   pen leans to, in degrees, 0 towards the user, 90 to the left. Angles of dabs, which the library counts
   clockwise as seen, come out anticlockwise. An eraser's dabs come with the part that it erases in alpha;
   other presets' with the part that they do not.

   Chance: the library's random numbers always begin alike; the seed chooses one of 16384 places in their
   sequence to begin at. At most about 65536 dabs come from one step. */
#pragma once
#include "brush/dab.h"
#include "brush/preset.h"

#include <stdbool.h>

#define WR_ENGINE_STEP 0.00390625 /* seconds: 1/256, exact in binary */
#define WR_ENGINE_SPEED 400.0     /* texels a second */
#define WR_ENGINE_REST 1.0        /* seconds */

typedef struct WrEngine WrEngine;

/* brush: sane, with its preset; radius and hardness take the place of the preset's own base values, flow,
 * the seed, angle, aspect, follow and jitter enter, and the tip's cell is chosen; mode, strength and the like
 * are the caller's. The preset's own angle counts where its dabs are longer than broad, or where a curve
 * turns them. Shares preset and tip. Dabs come with alpha > 0 only, and
 * finite. A radius below 0.2 counts as 0.2; 0 makes none. The
 * caller owns it. */
WrEngine *wr_engine_new(const WrBrush *brush, const WrDabSink *sink);
void wr_engine_free(WrEngine *engine); /* NULL is fine */

typedef struct WrEnginePoint {
    double x, y; /* texels, not wrapped: continuous along the stroke, any size */
    double pressure, tilt_x, tilt_y;
    double seconds; /* since the stroke's start */
} WrEnginePoint;

/* Take one more point; nothing is drawn yet. */
void wr_engine_push(WrEngine *engine, const WrEnginePoint *point);
/* Do one step, which may make dabs. False if there was none to do. */
bool wr_engine_step(WrEngine *engine);
/* The pen is lifted: the rest of the way, whatever is not a whole step. Then steps are there again. */
void wr_engine_finish(WrEngine *engine);
