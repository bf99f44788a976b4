/* scene_args.h - numbers, colours and switches of a scene as command arguments, by the rows of scene/param.h. `form`
   is the command's form, NULL without forms. Private to src/command. */
#pragma once
#include "base/vec.h"
#include "command/command_line.h"
#include "surface/surface.h"

typedef struct WrSceneParam WrSceneParam;
typedef struct WrError WrError;
typedef struct WrScene WrScene;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* Write their arguments in the table's order; returns their number. */
int wr_scene_args(const char *command, const char *form, WrArgSpec *out);
/* Store the line's values in `owner` (the scene, or the light); parameters without a value get their default if their
   row says so. */
void wr_scene_take(const WrCall *call, const char *form, void *owner);
/* Print " name=value" for each parameter that is written with its name. */
void wr_scene_print_params(const char *command, const char *form, const void *owner, WrText *text);
/* Rotation of the object as "x,y,z" or as the word for the surface's default pose. */
#define WR_OWN_TURN "own"
bool wr_scene_take_turn(const char *text, WrScene *scene, WrError *err);
/* The mesh part of `surface mesh`: reading its file into the scene; printing, with paths or only by content if the
 * checksum is known; its two argument rows. */
bool wr_run_mesh(WrSession *session, WrCall *call, WrScene *scene, WrError *err);
void wr_print_mesh(const WrScene *scene, bool content, WrText *text);
void wr_form_mesh(WrSurfaceKind kind, WrArgSpec *args);
void wr_form_terrain(WrArgSpec *args); /* changes and additions for a terrain: 0 and 2 rows */
void wr_scene_print_vec(WrVec3 v, WrText *text); /* "x,y,z" */
/* Print " name=word"; nothing if word is NULL. */
void wr_print_word(const char *name, const char *word, WrText *text);
/* Print the value of one parameter as "x,y,z". */
void wr_scene_print_value(const WrSceneParam *param, const void *owner, WrText *text);
