/* module_path.h - where the parts of the program that are not linked into it lie.
   Private to this module. */
#pragma once
#include "base/once_async.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_MODULE_PLACES 3

/* Where the file would lie in the place-th place: beside the program, where it is installed as seen from
 * there, in the folder that $WRINKLE_MODULES names. False if there is no such place. */
bool wr_module_path(int place, const char *file, WrText *path);

/* A module and what it is asked for; one static variable each, since which module is loaded is a fact of the
 * process: the one thing here that outlives a call. */
typedef struct WrModule {
    const char *file, *serves; /* "wrinkle_oiio.so", "picture files" */
    const char *symbol;        /* of its table, which begins with an int: its version */
    int version;
    const void *table;   /* NULL until it was loaded */
    WrOnceAsync loading; /* { wr_module_load, the module } */
} WrModule;
bool wr_module_load(void *module, WrError *err);

/* The module's table, loaded by the first call, which can be cancelled meanwhile (base/once_async.h). A failure is not
 * kept, so that a later call may succeed. NULL with one error that says where it was looked for, or that it was
 * cancelled. */
const void *wr_module_table(WrModule *module, WrError *err);
