/* fd_internal.h - functions shared by the fd*.c files.
   Belongs to one system; private to this module. */
#pragma once
#include "system/fd.h"

#include <sys/stat.h>

void wr_fd_info_of(const struct stat *from, WrFileInfo *to);
int wr_fd_flags(unsigned how);
