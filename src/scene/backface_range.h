/* backface_range.h - does the turntable show backs? On the back of an open surface one sees the table mirrored. */
#pragma once
#include <stdbool.h>

typedef struct WrScene WrScene;

/* Does a whole turn of the turntable show, of an object that is shown and turned, clearly more of its back than it shows
   unturned? Each border of the surface counts as a hole of its vector area, half the integral of P x dP along it: a hole
   that looks at the viewer shows the inside. So a plane, a disc or an open mesh does, and so does a vase that lies, but not a vase or
   a tube that stands, nor a closed body, were it a formula's. */
bool wr_scene_turn_shows_backs(const WrScene *scene);
