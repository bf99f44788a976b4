/* scene_args.h - the numbers, colours and switches of a scene as arguments of the command that sets them, by the rows of
   scene/param.h. `form` is the command's form, NULL where it has none.
   Layer 6, private to src/command. */
#pragma once
#include "command/call.h"

typedef struct WrSceneParam WrSceneParam;
typedef struct WrText WrText;

/* Their arguments, in the table's order; how many. */
int wr_scene_args(const char *command, const char *form, WrArgSpec *out);
/* What the line gives, and the default of what it does not give but fills, put into `owner`: the scene, or the light. */
void wr_scene_take(const WrCall *call, const char *form, void *owner);
/* " name=value" of each. */
void wr_scene_print_params(const char *command, const char *form, const void *owner, WrText *text);
/* "x,y,z" of one. */
void wr_scene_print_value(const WrSceneParam *param, const void *owner, WrText *text);
