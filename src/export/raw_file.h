/* raw_file.h - raw files of numbers, and the description file (sidecar) of any file (image/sidecar.h). Private
   to this module. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;

/* Writes the job's rows as numbers, which are verified before the file is renamed. */
bool wr_export_numbers(WrExportJob *job, const char *path, WrError *err);
/* Writes the description of the last written file, in the same group of files (base/file.h). */
bool wr_export_sidecar(WrExportJob *job, const char *path, WrError *err);
