/* scene_line.h - one command for what was dragged in the scene. */
#pragma once
#include "ui/desk/desk.h"

typedef struct WrText WrText;

/* Run a scene command whose value was being dragged; clears the line. */
void wr_scene_run(WrApp *app, WrText *line);
