"""The photograph library of lensprof, a shared library in this folder. `import lensprof` finds and loads it."""
