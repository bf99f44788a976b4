/* backface_range.h - test whether the turntable shows back faces, where the table appears mirrored. */
#pragma once
#include <stdbool.h>

typedef struct WrScene WrScene;

/* True if a whole turn of the turntable shows clearly more of the back of a visible, turning object
   than its initial view. Each border of the surface is a hole with a vector area, half the integral of
   P x dP along it: a hole that faces the viewer shows the inside. So the result is true for a plane, a
   disc, an open mesh and a lying vase, but false for a standing vase or tube, and for a closed body,
   even if it is given by a formula. */
bool wr_scene_turn_shows_backs(const WrScene *scene);
