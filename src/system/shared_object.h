/* shared_object.h - shared libraries loaded at run time.
   Belongs to one system: platform code, see src/README.md. */
#pragma once

/* Loads a library with its dependencies; its symbols stay local. NULL: wr_object_why returns the
 * reason. */
void *wr_object_open(const char *path);
void *wr_object_find(void *library, const char *symbol); /* NULL if missing */
void wr_object_close(void *library);
const char *wr_object_why(void);
