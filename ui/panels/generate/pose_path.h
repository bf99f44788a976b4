/* pose_path.h - canvas handles for the points of path data, a generator's parameter with `path`: drag moves one,
   Ctrl+click on the outline adds one, Ctrl+click on it or Delete removes it. The other points keep their places: size and
   position of the drawing follow its box. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/panels/generate/generate_state.h"

#include <stdbool.h>

typedef struct WrPointer WrPointer;

int wr_pose_path_param(const WrGenerateState *hand); /* index of that parameter; -1: none */
/* True if a point was hit, added or removed. */
bool wr_pose_path_press(WrApp *app, const WrPointer *at);
void wr_pose_path_drag(WrApp *app, const WrPointer *at);
bool wr_pose_path_remove(WrApp *app); /* the last point; false: there is none */
void wr_pose_path_marks(const WrApp *app);
