#pragma once

#define mjVERSION_HEADER 320

struct mjVFS {
  void* impl_;
};

extern "C" {
int mj_addBufferVFS(mjVFS* files, const char* name, const void* buffer, int size);
}

#include "../../mujoco.h"
