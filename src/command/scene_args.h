/* scene_args.h - the numbers, colours and switches of a scene as arguments of the command that sets them, by the rows of
   scene/param.h. `form` is the command's form, NULL where it has none.
   Layer 6, private to src/command. */
#pragma once
#include "base/vec.h"
#include "command/command_line.h"
#include "surface/surface.h"

typedef struct WrSceneParam WrSceneParam;
typedef struct WrError WrError;
typedef struct WrScene WrScene;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* Their arguments, in the table's order; how many. */
int wr_scene_args(const char *command, const char *form, WrArgSpec *out);
/* What the line gives, and the default of what it does not give but fills, put into `owner`: the scene, or the light. */
void wr_scene_take(const WrCall *call, const char *form, void *owner);
/* " name=value" of each that has its name in the line. */
void wr_scene_print_params(const char *command, const char *form, const void *owner, WrText *text);
/* The object's turn as "x,y,z" or that word: the pose in which its surface first shows itself. */
#define WR_OWN_TURN "own"
bool wr_scene_take_turn(const char *text, WrScene *scene, WrError *err);
/* What `surface mesh` does besides: its file read into the scene; printed, by content alone where that is known; its two
 * arguments. */
bool wr_run_mesh(WrSession *session, WrCall *call, WrScene *scene, WrError *err);
void wr_print_mesh(const WrScene *scene, bool content, WrText *text);
void wr_form_mesh(WrSurfaceKind kind, WrArgSpec *args);
void wr_form_terrain(WrArgSpec *args); /* what a terrain has otherwise, or besides: 0 and 2 */
/* The line of `surface` by the content of its file, whatever its path. */
void wr_print_surface_content(const WrScene *scene, WrText *text);
void wr_scene_print_vec(WrVec3 v, WrText *text); /* "x,y,z" */
/* " name=word", as a line has it; nothing where word is NULL. */
void wr_print_word(const char *name, const char *word, WrText *text);
/* "x,y,z" of one. */
void wr_scene_print_value(const WrSceneParam *param, const void *owner, WrText *text);
