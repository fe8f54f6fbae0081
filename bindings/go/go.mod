module lensprof

go 1.21
