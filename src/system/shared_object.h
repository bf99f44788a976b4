/* shared_object.h - shared libraries loaded at run time.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* Loads a library with its dependencies; its symbols stay local. NULL: wr_object_why returns the
 * reason. */
void *wr_object_open(const char *path);
void *wr_object_find(void *library, const char *symbol); /* NULL if missing */
void wr_object_close(void *library);
const char *wr_object_why(void);
/* Path of the library or program that holds a function or variable, as it was loaded; false if unknown. */
bool wr_object_path(const void *symbol, char *path, size_t size);
