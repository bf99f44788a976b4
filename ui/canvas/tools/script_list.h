/* script_list.h - scripts that ship with the program, with a picture beside each: cells and starters. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef struct WrScript {
    char *path, *picture; /* of the script, and of NAME.png or NAME.jpg beside it; owned */
    char *title, *words;  /* of its first line, "# TITLE: WORDS"; English; owned */
} WrScript;

/* Zeroed: not read yet. */
typedef struct WrScriptList {
    WR_ARRAY(WrScript) scripts; /* by title */
    bool known;
} WrScriptList;

/* Reads that folder of the program's data at the first call; a missing one is empty. */
void wr_script_list_find(WrScriptList *list, const char *folder);
void wr_script_list_free(WrScriptList *list); /* may be used again */
