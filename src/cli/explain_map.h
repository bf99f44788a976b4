/* explain_map.h - effect heatmap: a false-colour picture of the effects that ran in each pixel, and its legend.
   Private to src/cli. */
#pragma once
#include <stdbool.h>

typedef struct WrCli WrCli;
typedef struct WrError WrError;
typedef struct WrHeatmapCounts WrHeatmapCounts;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* True if cli->map is a valid name for such a picture. */
bool wr_map_check(const WrCli *cli, WrError *err);
/* Render the session's picture and write the effects of each pixel to cli->map. */
bool wr_map_write(const WrCli *cli, WrSession *session, WrHeatmapCounts *counts, WrError *err);
/* Print a line, or an array element, for each colour in the map. */
void wr_map_legend(const WrHeatmapCounts *counts, WrText *text);
void wr_map_legend_json(const WrHeatmapCounts *counts, WrText *text);
