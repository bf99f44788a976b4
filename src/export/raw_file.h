/* raw_file.h - files of nothing but numbers, and the sidecar beside any file that says what it is (image/sidecar.h).
   Layer 6. Private to this room. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;

/* The job's rows as numbers, read back before they take their name. */
bool wr_export_numbers(WrExportJob *job, const char *path, WrError *err);
/* The sidecar of the file that was written last, in the same group of files (base/file.h). */
bool wr_export_sidecar(WrExportJob *job, const char *path, WrError *err);
