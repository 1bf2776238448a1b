# docker build -t tethercalc . && docker run --rm -v "$PWD:/work" tethercalc optimize examples/holybro-x500.json
# scripts/test-container runs these steps where there is no builder.
FROM debian:12-slim AS build
COPY . /source
WORKDIR /source
RUN scripts/setup build package
RUN cmake --preset release -D CMAKE_INSTALL_PREFIX=/usr && cmake --build --preset release
RUN cd build/release && cpack -D CPACK_COMPONENTS_ALL=program && cp tethercalc_*.deb /tethercalc.deb

FROM debian:12-slim
COPY --from=build /tethercalc.deb /tmp/tethercalc.deb
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/tethercalc.deb && rm -rf /var/lib/apt/lists/* /tmp/tethercalc.deb
WORKDIR /work
ENTRYPOINT ["tethercalc"]
