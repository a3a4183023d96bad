#pragma once

#define mjVERSION_HEADER 222

struct mjVFS {
  void* filedata[2000];
};

extern "C" {
int mj_makeEmptyFileVFS(mjVFS* files, const char* name, int size);
int mj_findFileVFS(const mjVFS* files, const char* name);
}

#include "../../mujoco.h"
