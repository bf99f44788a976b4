/* module.h - where the parts of the program that are not linked into it lie.
   Private to this room. */
#pragma once
#include "base/text.h"

#define WR_MODULE_PLACES 3

/* Where the file would lie in the place-th place: beside the program, where it is installed as seen from
 * there, in the folder that $WRINKLE_MODULES names. False if there is no such place. */
bool wr_module_path(int place, const char *file, WrText *path);
