/* panel_objects.h - state of the objects section. */
#pragma once
#include "document/document.h"

/* Name of the active object while it is typed. */
typedef struct WrObjectsState {
    char name[WR_LAYER_NAME_MAX + 1];
    char of[WR_LAYER_NAME_MAX + 1]; /* name at the start */
} WrObjectsState;

typedef struct WrApp WrApp;
/* Handle the chosen file for the active object's table. */
void wr_object_table_file_chosen(WrApp *app, const char *path);
