/* panel_objects.h - the list of objects: its own state. */
#pragma once
#include "document/document.h"

/* The name of the object at hand as it is being written. */
typedef struct WrObjectsHand {
    char name[WR_LAYER_NAME_MAX + 1];
    char of[WR_LAYER_NAME_MAX + 1]; /* what it was taken from */
} WrObjectsHand;

typedef struct WrApp WrApp;
/* A file was chosen as the chosen object's table. */
void wr_object_table_take(WrApp *app, const char *path);
