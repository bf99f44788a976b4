/* remedy.h - the command that an error names as its remedy, "...: `layer set 2 visible=on` shows it", as a button. */
#pragma once
#include <stdbool.h>

typedef struct WrRemedy {
    int length;        /* of the text before it, bytes */
    char line[160];    /* the command */
    const char *label; /* of the button, English */
} WrRemedy;

/* The first command between backquotes that is complete and in the table of remedy.c. False: there is none. */
bool wr_remedy_find(const char *text, WrRemedy *remedy);
