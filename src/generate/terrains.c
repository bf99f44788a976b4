#include "generate/terrain.h"

const WrGenerator wr_terrains[] = {
    { "terrain", "fractal", "Fractal",
      "mountains by sums of noise, finer on heights and off slopes", "replace", wr_params_fractal,
      wr_terrain_fractal },
    { "terrain", "elevation", "Elevation",
      "real heights from a picture of 16 bits or floats, or from bare numbers", "replace",
      wr_params_elevation, wr_terrain_elevation },
    { "terrain", "hydraulic", "Rain",
      "rain runs over what lies there, cuts valleys and fills hollows; no ground is lost. It falls "
      "in places of the table: a rolled table weathers otherwise",
      "replace", wr_params_hydraulic, wr_terrain_hydraulic },
    { "terrain", "thermal", "Scree",
      "what lies there slides where it is steeper than the angle of rest; no ground is lost",
      "replace", wr_params_thermal, wr_terrain_thermal },
    { "terrain", "terraces", "Terraces", "what lies there, cut into steps", "replace",
      wr_params_terraces, wr_terrain_terraces },
    { .family = NULL },
};
