// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Columns of matrices times the light of probes (prt_gloss_vertices.glsl).
#ifndef GLOAM_PRT_LOCAL_GLOSS_COLUMNS_GLSL
#define GLOAM_PRT_LOCAL_GLOSS_COLUMNS_GLSL

#define LOAD_COLUMN(a)                                           \
  if (a < kColumns) {                                            \
    ProbeLight of_column = blended(local.first_job, a, blend, light_all[a]); \
    light[a] = of_column.direct;                                 \
    light_reflected[a] = of_column.reflected;                    \
  } else {                                                       \
    light[a] = light_reflected[a] = light_all[a] = vec3(0.0);    \
  }
#define LOAD_LIGHT(a, b) LOAD_COLUMN(a) LOAD_COLUMN(b)
// What others reflect is indirect, the first time it arrives too.
#define ADD_COLUMN(a)                       \
  if (a < kColumns) {                       \
    first += gs(i, a) * light[a];           \
    further += gs(i, a) * light_reflected[a]; \
  }
#define ADD_MATRIX(a, b) ADD_COLUMN(a) ADD_COLUMN(b)
#define ADD_INDIRECT(a, b) further += pair(i, a / 2, light_all[a], light_all[b]);

#endif
