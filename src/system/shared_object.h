/* shared_object.h - shared objects that are loaded while the program runs.
   Belongs to one system: platform code, see src/README.md. */
#pragma once

/* Load it with all that it needs; its names are nobody else's. NULL, and wr_object_why says why. */
void *wr_object_open(const char *path);
void *wr_object_find(void *library, const char *symbol); /* NULL */
void wr_object_close(void *library);
const char *wr_object_why(void);
