// Carries the precompiled header; catch_main.cpp cannot, since it defines what Catch reads first.
