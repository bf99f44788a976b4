/* module_path.h - search and loading of the program's run-time modules. */
#pragma once
#include "base/pool.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_MODULE_PLACES 3

/* Path of the file at the place-th place: beside the program, in the installed folder relative to it,
 * in the folder $WRINKLE_MODULES. False if there is no such place. */
bool wr_module_path(int place, const char *file, WrText *path);

/* A module and its interface; one static variable each, since a module is loaded once per process. It
 * is the only state here that outlives a call. */
typedef struct WrModule {
    const char *file, *serves; /* "wrinkle_oiio.so", "picture files" */
    const char *package;       /* Debian package of its library, for errors; NULL or "": unknown */
    const char *symbol;        /* name of its table, which begins with an int: its version */
    int version;
    bool quiet;          /* its libraries start no threads when they are loaded */
    const void *table;   /* NULL until loaded */
    WrOnceAsync loading; /* { wr_module_load, the module } */
} WrModule;
bool wr_module_load(void *module, WrError *err);

/* The module's table, loaded by the first call, which can be cancelled meanwhile (base/pool.h). A
 * failure is not cached, so that a later call may succeed. NULL with one error, or "cancelled": the
 * system's reason and the package of a module that does not load, else the searched paths. */
const void *wr_module_table(WrModule *module, WrError *err);
/* For the sandboxed children of the reader process, which cannot open modules: from now on in this process a module that
 * failed to load fails again with the same error. */
void wr_modules_seal(void);
