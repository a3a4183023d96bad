#pragma once

#define COAL_VERSION "stand-in"
