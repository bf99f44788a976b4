/* patch_projection.h - handle of a mesh's projection on the patch: moves, turns and scales the table on the mesh. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/patch/patch_objects.h"

#include "surface/projection.h"

#include <stdbool.h>

typedef struct WrText WrText;

/* Action of the handle: a switch for a mesh with a projection. */
void wr_act_projection_handle(WrApp *app);
bool wr_can_project(const WrApp *app);
bool wr_is_projecting(const WrApp *app);
/* True if the handle is shown in place of the object's. */
bool wr_patch_projects(const WrApp *app);

/* Its origin, in the mesh's coordinates. */
WrVec3 wr_projection_origin(const WrScene *scene);
/* Smallest cell, mm, for which the mesh stays within WR_PROJECTION_CELLS: about an axis it is up to two pi times as
   wide. */
double wr_projection_least_cell(const WrScene *scene, const WrProjection *is);
/* Shows the projection during a drag; large meshes show it at the drag's end. */
void wr_projection_live(WrApp *app, const WrProjection *is);

void wr_patch_projection_drag(WrApp *app, const WrPatchBall *ball, const WrPointer *at);
/* Appends the command for the end of a drag. */
void wr_patch_projection_line(const WrApp *app, WrText *line);
/* The projection's axes, and one cell of the table. */
void wr_patch_projection_draw(const WrApp *app, const WrPatchBall *ball);
